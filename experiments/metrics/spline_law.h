// The law of texton noise by quadrature: what statements about it are held against. It shares with the methods the
// values of B-splines and nothing of their closed forms.
#pragma once

#include <vector>

#include "methods/base/texton.h"
#include "methods/method.h"

namespace textonbench {

/// Null unless the model sums B-splines of one texton that is zero in no channel.
const SplineTexton* single_spline_texton(const Model& model);

/// ∫ β^order(t) β^order(t + x) dt, to rounding: six Gauss–Legendre nodes between each two knots of either factor, which
/// are exact up to degree 11.
double spline_correlation(int order, double x);

/// Covariance Σ_j a(j) B(v1 − j1) B(v2 − j2) of the noise of a single texton at any lag v of the plane, channel by
/// channel: a is the autocorrelation of the coefficients, B = spline_correlation.
class SplineCovariance {
 public:
  explicit SplineCovariance(const SplineTexton& texton);
  double at(int channel, double x, double y) const;
  int channels() const { return static_cast<int>(correlations_.size()); }
  /// Sum over the channels.
  double total(double x, double y) const;

 private:
  int order_;
  Extent extent_;                                  // of the coefficients
  std::vector<std::vector<double>> correlations_;  // lags |j1| < W, |j2| < H, row by row
};

/// h_c(x, y) from its definition, coefficient (0, 0) at the origin.
double spline_kernel(const SplineTexton& texton, int channel, double x, double y);

}  // namespace textonbench
