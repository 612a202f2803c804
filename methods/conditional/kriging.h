// Simple kriging of a stationary Gaussian field (Lectures 2022, "Gaussian conditional sampling using kriging
// estimation"): the conditional mean of a field given its values at the pixels C is
//
//   F*(x) = Σ_{c in C} Γ(x, c) k(c),   Γ_CC k = F_C.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "methods/base/mask.h"
#include "methods/base/random.h"
#include "methods/conditional/covariance.h"

namespace textonbench {

/// The operator Γ_CC + ν² I, and what goes with it. Unknowns are ordered channel by channel: unknown c * points + i is
/// channel c of conditioning pixel i (row by row). Immutable: threads may share it.
class KrigingOperator {
 public:
  /// `conditioning` and `missing` are masks of the picture's size; neither is empty, and they do not meet. Throws
  /// std::invalid_argument otherwise.
  KrigingOperator(GaussianField field, const Mask& conditioning, const Mask& missing);

  int unknowns() const { return field_.channels() * points(); }
  int points() const { return static_cast<int>(conditioning_.size()); }
  int channels() const { return field_.channels(); }
  const GaussianField& field() const { return field_; }
  const BoxCovariance& covariance() const { return covariance_; }
  /// Conditioning and missing pixels, in the coordinates of the picture.
  std::span<const Pixel> conditioning_pixels() const { return conditioning_; }
  std::span<const Pixel> missing_pixels() const { return missing_; }
  /// The smallest rectangle that holds both.
  const Rectangle& box() const { return box_; }

  /// out = (Γ_CC + ν² I) x.
  void apply(std::span<const double> x, std::span<double> out) const;

  /// Γ_MC k at the missing pixels, channel by channel: element c * missing_pixels().size() + i.
  std::vector<double> extend(std::span<const double> k) const;

  /// A field's values where they matter.
  struct Values {
    std::vector<double> conditioning;  ///< as unknowns
    std::vector<double> missing;       ///< as extend()
  };
  /// Unconditional sample of the field minus its mean, nugget included.
  Values simulate(Seed seed) const;

  std::size_t bytes() const;

 private:
  GaussianField field_;
  std::vector<Pixel> conditioning_, missing_;
  Extent picture_;
  Rectangle box_;
  BoxCovariance covariance_;
};

/// The lag between two pixels, in the coordinates that BoxCovariance::Lags takes.
inline Pixel lag(const Pixel& a, const Pixel& b) { return {a.x - b.x, a.y - b.y}; }

}  // namespace textonbench
