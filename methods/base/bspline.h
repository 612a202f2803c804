// Centered cardinal B-splines β^n of order n = 0 … 5, and the samples of their autocorrelation.
//
// β^0 is 1 on [−1/2, 1/2) and β^n = β^0 * β^(n−1), of support (−(n+1)/2, (n+1)/2). A function Σ_j α(j) β^n(x − j) has
// at x the order + 1 taps j = first … first + n, with weights β^n(x − j) of sum 1 (Unser 1999).
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace textonbench {

constexpr int max_bspline_order = 5;

/// β^order(x), of any order up to 2 max_bspline_order + 1.
double bspline(int order, double x);

struct BsplineTaps {
  std::int64_t first = 0;
  std::array<double, max_bspline_order + 1> weights{};  ///< of the coefficients first … first + order
};

/// Taps at x, of order 0 … max_bspline_order. |x| < 2^53.
BsplineTaps bspline_taps(int order, double x);

/// Weights of the same coefficients in the derivative at x. order >= 1; at order 1 the derivative from the right where
/// x is whole.
BsplineTaps bspline_derivative_taps(int order, double x);

/// b(j) = ∫ β^order(x) β^order(x + j) dx = β^(2 order + 1)(j) for j = 0 … order: covariance at whole lags of a sum of
/// β^order at random points. Zero for larger j, and b(−j) = b(j).
std::span<const double> bspline_autocorrelation(int order);

/// b̂(f) = Σ_j b(j) cos(2πfj), f in cycles a sample: positive, at most b̂(0) = 1, least at f = 1/2.
double bspline_power(int order, double frequency);

}  // namespace textonbench
