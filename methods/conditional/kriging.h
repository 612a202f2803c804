// Simple kriging of a stationary Gaussian field (Lectures 2022, "Gaussian conditional sampling using kriging
// estimation"): the conditional mean of a field of mean zero given its values at the pixels C is
//
//   F*(x) = Σ_{c in C} Γ(x, c) k(c),   Γ_CC k = F_C.
#pragma once

#include <span>
#include <vector>

#include "methods/base/mask.h"
#include "methods/base/random.h"
#include "methods/conditional/covariance.h"

namespace textonbench {

/// The operator Γ_CC + ν² I, and what goes with it. Unknowns are ordered channel by channel: unknown c * points() + i
/// is channel c of conditioning pixel i. Immutable: threads may share it.
class KrigingOperator {
 public:
  using Workspace = BoxCovariance::Workspace;

  /// `conditioning` and `missing` are masks of the picture's size. Throws std::invalid_argument when one is empty, they
  /// have a pixel in common, or their sizes differ.
  KrigingOperator(GaussianField field, const Mask& conditioning, const Mask& missing);

  int points() const { return static_cast<int>(conditioning_.size()); }
  int channels() const { return field_.channels(); }
  std::size_t unknowns() const { return conditioning_.size() * static_cast<std::size_t>(channels()); }
  const GaussianField& field() const { return field_; }
  const BoxCovariance& covariance() const { return covariance_; }
  /// In the coordinates of the picture, row by row.
  std::span<const Pixel> conditioning_pixels() const { return conditioning_; }
  std::span<const Pixel> missing_pixels() const { return missing_; }
  /// The smallest rectangle that holds both: covariance().box() is its size.
  const Rectangle& box() const { return box_; }

  /// out = (Γ_CC + ν² I) x.
  void apply(std::span<const double> x, std::span<double> out, Workspace& workspace) const;

  /// Γ_MC k, M the missing pixels, channel by channel: element c * missing_pixels().size() + i.
  std::vector<double> extend(std::span<const double> k) const;

  /// The covariance matrix of some conditioning pixels, given by their numbers: C n x C n, channel by channel, column
  /// by column, nugget included. `table` reaches all lags between them.
  void fill_matrix(std::span<const int> points, const CovarianceTable& table, double* matrix) const;

  /// A sample of the field minus its mean, nugget included, where it matters.
  struct Values {
    std::vector<double> conditioning;  ///< as unknowns
    std::vector<double> missing;       ///< as extend()
  };
  Values simulate(Seed seed) const;

  /// Unknowns in their places in the box, zero elsewhere; and the values of planes of that size at pixels of the
  /// picture, channel by channel.
  Planes scattered(std::span<const double> values) const;
  std::vector<double> gathered(const Planes& fields, std::span<const Pixel> pixels) const;

  std::size_t bytes() const;

 private:
  GaussianField field_;
  std::vector<Pixel> conditioning_, missing_;
  Extent picture_;
  Rectangle box_;
  BoxCovariance covariance_;
};

}  // namespace textonbench
