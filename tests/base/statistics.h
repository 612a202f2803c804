// Hypothesis tests for random output. A p-value is the probability, under the hypothesis, of a statistic at least as
// extreme; a test that rejects below p has the false-alarm rate p.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace textonbench {

/// Φ(x) of the standard normal law.
inline double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// Two-sided p-value of a standard normal statistic.
inline double normal_p_value(double z) { return std::erfc(std::fabs(z) / std::numbers::sqrt2); }

/// P(χ² >= statistic) for the given degrees of freedom: the upper regularized incomplete gamma function at
/// (degrees / 2, statistic / 2), by its series below the mode and its continued fraction above (Numerical Recipes 6.2).
inline double chi_square_p_value(double statistic, double degrees) {
  const double a = degrees / 2;
  const double x = statistic / 2;
  if (x <= 0) {
    return 1;
  }
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double sum = 1 / a;
    double term = sum;
    for (double n = a + 1; term > sum * 1e-16; ++n) {
      term *= x / n;
      sum += term;
    }
    return 1 - scale * sum;
  }
  double b = x + 1 - a;
  double c = std::numeric_limits<double>::max();
  double d = 1 / b;
  double fraction = d;
  for (int i = 1; i < 100000; ++i) {
    const double numerator = -i * (i - a);
    b += 2;
    d = 1 / (numerator * d + b);
    c = b + numerator / c;
    fraction *= c * d;
    if (std::fabs(c * d - 1) < 1e-15) {
      break;
    }
  }
  return scale * fraction;
}

/// Pearson's χ² test of counts against expected counts (a bin each; expected counts of at least about 10).
inline double chi_square_p_value(std::span<const double> counts, std::span<const double> expected) {
  double statistic = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    statistic += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  }
  return chi_square_p_value(statistic, static_cast<double>(counts.size()) - 1);
}

/// Kolmogorov–Smirnov test of independent samples against the continuous law `cdf`; the asymptotic p-value is good for
/// more than about 100 samples.
template <class Cdf>
double kolmogorov_smirnov_p_value(std::vector<double> samples, const Cdf& cdf) {
  std::ranges::sort(samples);
  const auto n = static_cast<double>(samples.size());
  double distance = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double p = cdf(samples[i]);
    distance = std::max({distance, static_cast<double>(i + 1) / n - p, p - static_cast<double>(i) / n});
  }
  const double t = distance * (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n));
  double p_value = 0;
  for (int k = 1; k <= 100; ++k) {
    p_value += (k % 2 == 1 ? 2 : -2) * std::exp(-2.0 * k * k * t * t);
  }
  return t < 0.2 ? 1 : std::clamp(p_value, 0.0, 1.0);
}

}  // namespace textonbench
