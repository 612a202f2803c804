#include "experiments/statistics/student.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace textonbench {
namespace {

/// P(T <= sqrt(degrees) tan θ).
double cdf_at_angle(double theta, int degrees) {
  const double sine = std::sin(theta), cosine = std::cos(theta);
  // Odd degrees: cos θ + 2/3 cos³ θ + …; even degrees: 1 + 1/2 cos² θ + …
  const bool odd = degrees % 2 == 1;
  double sum = 0;
  double term = odd ? cosine : 1;
  for (int k = odd ? 1 : 0; k <= degrees - 2; k += 2) {
    sum += term;
    term *= cosine * cosine * (k + 1) / (k + 2);
  }
  const double inside = odd ? (theta + sine * sum) * 2 / std::numbers::pi : sine * sum;
  return 0.5 + inside / 2;
}

void require_degrees(int degrees) {
  if (degrees < 1) throw std::invalid_argument(fmt::format("Student's t: {} degrees: expected at least 1", degrees));
}

}  // namespace

double student_cdf(double t, int degrees) {
  require_degrees(degrees);
  return cdf_at_angle(std::atan(t / std::sqrt(static_cast<double>(degrees))), degrees);
}

double student_quantile(double p, int degrees) {
  require_degrees(degrees);
  if (!(p > 0 && p < 1)) throw std::invalid_argument(fmt::format("Student's t: p = {}: expected in (0, 1)", p));
  double low = -std::numbers::pi / 2, high = std::numbers::pi / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (cdf_at_angle(middle, degrees) < p ? low : high) = middle;
  }
  return std::sqrt(static_cast<double>(degrees)) * std::tan((low + high) / 2);
}

}  // namespace textonbench
