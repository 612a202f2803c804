// Skewness and excess kurtosis of a spot noise in closed form: how far a number of impacts leaves it from its Gaussian
// limit.
//
// With MNI impacts over a pixel (λ = MNI / |S| a pixel), each of one of K kernels, and s(x) = Σ_k h_k(x)², a channel
// has
//
//   Poisson      skewness  K^{1/2} Σ_k Σ_x h_k³ / (λ^{1/2} (Σ s)^{3/2}),
//                excess kurtosis  K Σ_k Σ_x h_k⁴ / (λ (Σ s)²);
//   stratified   skewness  0,
//                excess kurtosis, averaged over pixels,
//                  [K Σ_k Σ_x h_k⁴ − 3 Σ_v R_s(v) q_1(v_1) q_2(v_2)] / (λ (Σ s)²),
//
// R_s being the autocorrelation of s, and q_i(v) the probability that two independent points of a cell have coordinates
// v pixels apart along axis i, averaged over the cells: E[s over the cell]² summed over all cells. (Of a cell, the
// fourth cumulant is E g⁴ − 3 (E g²)², g being the kernel at its random place.)
#pragma once

#include <Eigen/Core>
#include <vector>

#include "methods/base/texton.h"
#include "methods/spot/impacts.h"

namespace textonbench {

struct NoiseMoments {
  double skewness = 0;
  double excess_kurtosis = 0;
};

/// Bounds of the excess kurtosis over the pixels: stratified impacts are stationary to second order only, their fourth
/// order follows the cells.
struct KurtosisRange {
  double least = 0;
  double greatest = 0;
};

/// One a channel. A channel that is zero has the moments 0.
std::vector<NoiseMoments> poisson_moments(const Texton& texton, double mni);

/// Kurtosis of stratified impacts, for textons whose R_s has been computed once.
class StratifiedMoments {
 public:
  explicit StratifiedMoments(const Texton& texton);
  /// One a channel, with the cells of `lattice`: plane_lattice(mni / texton.support_pixels) on the plane.
  std::vector<NoiseMoments> on(const CellLattice& lattice) const;
  /// One a channel, over up to 24 x 24 pixels spread over three cells' length.
  std::vector<KurtosisRange> range_on(const CellLattice& lattice) const;

 private:
  struct Channel {
    double fourth = 0;  ///< K Σ_k Σ_x h_k⁴
    double energy = 0;  ///< Σ s
    Eigen::MatrixXd s;
    Image overlap;  ///< R_s on a torus that is large enough for all its lags, lag (0, 0) at pixel (0, 0)
  };
  Extent extent_;
  std::vector<Channel> channels_;
};

/// q(v) for v = 0, 1, …, up to the last that is not zero; q(−v) = q(v).
std::vector<double> cell_difference_law(const CellAxis& axis);

/// Smallest MNI from which on |excess kurtosis| < bound in every channel.
double poisson_impacts_needed(const Texton& texton, double bound);
/// The same to one per cent for stratified impacts on the plane, at least 1.
double stratified_impacts_needed(const Texton& texton, double bound);

}  // namespace textonbench
