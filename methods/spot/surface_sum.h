// Texton noise on a surface in space (Galerne, Leclaire, Moisan, CGF 2017, Section 6), without coordinates on it.
//
// Impacts x_i fall in space, and at a point y of the surface with the frame (u1, u2, n) each adds its kernel as seen in
// the tangent plane, the less the farther it is from that plane:
//
//   f(y) = Σ_i w_i (1 − (2/r) |<y − x_i, n>|)₊ h(<y − x_i, u1>, <y − x_i, u2>),
//
// where r is the longer side of h's box, whose center h has at (0, 0). With λ impacts a unit of volume (Proposition 3)
// E f = λ (r/2) ∫h for weights 1, Var f = λ (r/3) ∫h², and MNI = λ r |S|, so that
//
//   g = m + (f − E f) / sqrt(λ r / 3)
//
// has mean m and the variance of the noise of the plane. Excess kurtosis is 9/5 of that of the plane at the same MNI.
// One signed impact a cell serves as well as Poisson impacts: the second moments of a sum of independent signed terms
// do not see the cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "methods/base/impact_grid.h"
#include "methods/base/random.h"
#include "methods/base/surface_view.h"
#include "methods/base/texton.h"

namespace textonbench {

struct SurfaceImpact {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::int32_t kernel = 0;
  float weight = 1;
};

/// Cubic cells of side a: Poisson impacts, or one signed impact each.
class SpaceGrid {
 public:
  /// `intensity` impacts a unit of volume, above 0; `side` of Poisson cells, while those of one impact have the volume
  /// of an impact. Throws std::invalid_argument for ImpactProcess::paper or a mean number of impacts a cell out of
  /// range.
  SpaceGrid(ImpactProcess process, double intensity, double side, int kernels);

  double side() const { return side_; }
  ImpactProcess process() const { return process_; }
  /// poisson_thresholds() of a cell's mean, none for one impact a cell.
  const std::vector<std::uint32_t>& thresholds() const { return thresholds_; }
  /// Expected sum of weights a unit of volume.
  double mean_weight() const { return process_ == ImpactProcess::stratified ? 0 : intensity_; }
  /// Impacts of the cell [cx a, (cx + 1) a) x …, in their order, after those that are there. |cx|, |cy|, |cz| < 2^31.
  void draw_cell(const Stream& stream, std::int32_t cx, std::int32_t cy, std::int32_t cz,
                 std::vector<SurfaceImpact>& impacts) const;

 private:
  ImpactProcess process_;
  double intensity_;
  double side_;
  std::uint32_t kernels_;
  std::vector<std::uint32_t> thresholds_;
};

struct SurfaceSumOptions {
  ImpactProcess impacts = ImpactProcess::poisson;
  double mni = 60;    ///< mean number of impacts whose kernels reach a point
  double cell = 0.6;  ///< side of Poisson cells in units of r
};

class SurfaceSum {
 public:
  static constexpr double furthest_coordinate = 1 << 20;  ///< pixels

  /// Throws std::invalid_argument for options out of range.
  SurfaceSum(SplineTexton texton, const SurfaceSumOptions& options);

  /// out[c * points.size() + i] = channel c at points[i], in pixels of the exemplar. Quick where consecutive points are
  /// near to each other; the bits of a value depend on its own point alone. Throws std::invalid_argument for a point
  /// that is not finite or beyond furthest_coordinate.
  void evaluate(std::span<const SurfacePoint> points, Seed seed, std::span<float> out) const;

  const SplineTexton& texton() const { return texton_; }
  const SpaceGrid& grid() const { return grid_; }
  /// r, pixels.
  double thickness() const { return thickness_; }
  /// λ, impacts a cubic pixel.
  double intensity() const { return intensity_; }
  /// Of a kernel in the sums: sqrt(K / (λ r / 3)).
  double scale() const;
  /// What the sums are added to, a channel each: m − E f / sqrt(λ r / 3).
  const std::vector<double>& start() const { return start_; }
  /// Of the words of cells: Philox of this key and the counter (cz, j, cx, cy).
  static std::uint64_t key(Seed seed);

 private:
  void evaluate_near(std::span<const SurfacePoint> points, const Stream& stream, std::span<double> sums) const;
  void add(const SurfacePoint& point, const SurfaceImpact& impact, std::span<double> sums) const;

  SplineTexton texton_;
  double thickness_;
  double intensity_;
  SpaceGrid grid_;
  std::vector<double> start_;
};

}  // namespace textonbench
