// Stratified sampling of a power spectrum (Gilet et al., SIGGRAPH Asia 2014, sections 4.1 to 4.3).
//
// Bins are those of a torus of T x T pixels, T even: frequency (kx, ky) / T with kx, ky in (−T/2, T/2]. A spectrum is
// symmetric, so strata are kept as the half 0 <= kx, with ky >= 0 in the columns kx = 0 and T/2, which are their own
// mirror images.
#pragma once

#include <vector>

#include "methods/base/mask.h"
#include "methods/base/random.h"
#include "methods/sparse/lrp_window.h"

namespace textonbench {

/// Power of each bin, P(kx, ky) >= 0.
class PowerPlane {
 public:
  explicit PowerPlane(int side);
  int side() const { return side_; }
  /// Any kx, ky: taken modulo the side, mirrored where need be.
  double at(int kx, int ky) const { return values_[index(kx, ky)]; }
  void set(int kx, int ky, double power) { values_[index(kx, ky)] = power; }
  /// The bins of the half, row after row, and how many bins of the whole plane such a one stands for: 1 or 2.
  std::vector<Pixel> half() const;
  int multiplicity(const Pixel& bin) const;
  /// Σ P over the whole plane.
  double total() const;

 private:
  std::size_t index(int kx, int ky) const;
  int side_;
  std::vector<double> values_;
};

/// A set of bins of like power.
struct Stratum {
  std::vector<Pixel> bins;  ///< of the half
  int area = 0;             ///< bins of the whole plane, |S|
  double energy = 0;        ///< Σ P over them
  int cosines = 0;          ///< J_S
  double spacing = 0;       ///< of the lattice of windows, Δ_S = T sqrt(J_S / (2 |S|)) pixels times the factor
  std::vector<std::vector<Pixel>> parts;  ///< J_S disjoint sets of bins, none empty: one is drawn of each
  std::vector<double> part_energy;        ///< Σ P over the bins of the stratum that are nearest to each part's center
};

struct StrataOptions {
  int strata = 4;
  int cosines = 50;
  LrpWindow window = LrpWindow::bessel;
  double spacing = 1;  ///< factor of all Δ_S
  double kept = 0.99;  ///< part of the power that strata are cut from: the weakest bins beyond it belong to none
};

/// The bins whose distance on the torus to a bin outside of the set is at least `distance`; and where a connected piece
/// of the set (eight neighbors) is narrower, its middle: bins with no neighbor that is farther from the outside by more
/// than half a bin, and none within `distance` that is more than half as far again. When fewer than `least` bins of the
/// half remain, the distance is shortened until there are as many, or all.
std::vector<Pixel> erode_bins(const std::vector<Pixel>& bins, int side, double distance, std::size_t least);

/// k-means (Lloyd's iterations from k-means++ seeds) in `parts` parts, none empty. parts <= bins.size().
std::vector<std::vector<Pixel>> cluster_bins(const std::vector<Pixel>& bins, int parts, const Stream& stream);

/// Strata of equal energy (within that of one bin), from the most to the least power, each with its parts. Bins whose
/// power is below 1e-12 of the largest, and those beyond `kept`, belong to none, and strata that would be empty are
/// left out: there are fewer when single bins hold much of the energy. Cosines are shared evenly, but a stratum takes
/// no more than it has bins in the half, and the rest goes to the others. Throws std::invalid_argument unless 1 <=
/// strata <= cosines, the factor and some power are positive.
std::vector<Stratum> stratify(const PowerPlane& power, const StrataOptions& options, const Stream& stream);

}  // namespace textonbench
