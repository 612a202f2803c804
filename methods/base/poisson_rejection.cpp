#include "methods/base/poisson_rejection.h"

#include <cmath>

#include "methods/base/portable_math.h"

namespace textonbench {
namespace {

/// log(n!) − [log sqrt(2πn) + n log n − n] for n > 15: Stirling's series, error below 1e-15.
double stirling_error(double n) {
  const double n2 = n * n;
  return (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - (1.0 / 1680 - 1.0 / 1188 / n2) / n2) / n2) / n2) / n;
}

/// k log(k / mean) + mean − k without cancellation (Loader 2000).
double deviance(double k, double mean) {
  const double difference = k - mean;
  if (std::fabs(difference) >= 0.1 * (k + mean)) {
    return k * portable::log(k / mean) - difference;
  }
  const double v = difference / (k + mean);
  double sum = difference * v;
  double power = 2 * k * v;
  for (int j = 1; j < 1000; ++j) {
    power *= v * v;
    const double next = sum + power / (2 * j + 1);
    if (next == sum) {
      break;
    }
    sum = next;
  }
  return sum;
}

}  // namespace

PoissonRejection poisson_rejection(double mean) {
  PoissonRejection numbers;
  numbers.b = 0.931 + 2.53 * std::sqrt(mean);
  numbers.a = -0.059 + 0.02483 * numbers.b;
  numbers.inverse_alpha = 1.1239 + 1.1328 / (numbers.b - 3.4);
  numbers.v_r = 0.9277 - 3.6224 / (numbers.b - 2);
  return numbers;
}

double log_poisson(double k, double mean) {
  constexpr double half_log_two_pi = 0.91893853320467274178;
  if (k <= 15) {
    double factorial = 1;
    for (int i = 2; i <= static_cast<int>(k); ++i) {
      factorial *= i;
    }
    return k * portable::log(mean) - mean - portable::log(factorial);
  }
  return -stirling_error(k) - deviance(k, mean) - half_log_two_pi - 0.5 * portable::log(k);
}

}  // namespace textonbench
