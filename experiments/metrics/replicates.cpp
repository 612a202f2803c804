#include "experiments/metrics/replicates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "methods/base/parallel.h"

namespace textonbench {

Replicates draw_replicates(int count, const std::function<std::vector<float>(int)>& draw) {
  Replicates replicates(static_cast<std::size_t>(count));
  parallel_for(count, [&](int i) { replicates[static_cast<std::size_t>(i)] = draw(i); });
  return replicates;
}

double largest_deviation(const Replicates& replicates, std::span<const double> expected) {
  if (replicates.size() < 2) {
    throw std::invalid_argument(fmt::format("{} replicates: expected at least 2", replicates.size()));
  }
  std::vector<double> sum(expected.size()), squares(expected.size());
  for (const std::vector<float>& replicate : replicates) {
    if (replicate.size() != expected.size()) {
      throw std::invalid_argument(
          fmt::format("a replicate of {} entries: expected {}", replicate.size(), expected.size()));
    }
    for (std::size_t j = 0; j < expected.size(); ++j) {
      const double difference = replicate[j] - expected[j];
      sum[j] += difference;
      squares[j] += difference * difference;
    }
  }
  const auto count = static_cast<double>(replicates.size());
  double largest = 0;
  for (std::size_t j = 0; j < expected.size(); ++j) {
    if (sum[j] == 0) continue;
    const double variance = std::max(0.0, squares[j] - sum[j] * sum[j] / count) / (count - 1);
    if (variance == 0) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::fabs(sum[j] / count) / std::sqrt(variance / count));
  }
  return largest / standard_error_limit(expected.size(), static_cast<int>(replicates.size()));
}

double standard_error_limit(std::size_t comparisons, int replicates) {
  constexpr double false_alarms = 0.01;
  const double tail = false_alarms / static_cast<double>(comparisons);
  double low = 0, high = 38;  // beyond, erfc is no longer a normal number
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::erfc(middle / std::numbers::sqrt2) > tail ? low : high) = middle;
  }
  const double z = low, degrees = replicates - 1;
  return z + z * (z * z + 1) / (4 * degrees) + z * ((5 * z * z + 16) * z * z + 3) / (96 * degrees * degrees);
}

}  // namespace textonbench
