#include "experiments/statistics/hypothesis_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>

namespace textonbench {
namespace {

constexpr std::size_t most_for_exact = 25;

struct Ranked {
  std::vector<int> doubled;   ///< twice the rank of each difference, so that mean ranks are whole
  int positive = 0;           ///< sum over the positive differences
  double tie_correction = 0;  ///< Σ (t³ − t) over the groups of t equal magnitudes
};

Ranked rank(std::vector<double> differences) {
  std::erase(differences, 0.0);
  std::sort(differences.begin(), differences.end(), [](double a, double b) { return std::fabs(a) < std::fabs(b); });
  Ranked ranked;
  for (std::size_t first = 0; first < differences.size();) {
    std::size_t end = first;
    while (end < differences.size() && std::fabs(differences[end]) == std::fabs(differences[first])) ++end;
    const auto doubled = static_cast<int>(first + 1 + end);
    const auto ties = static_cast<double>(end - first);
    ranked.tie_correction += ties * ties * ties - ties;
    for (; first < end; ++first) {
      ranked.doubled.push_back(doubled);
      if (differences[first] > 0) ranked.positive += doubled;
    }
  }
  return ranked;
}

/// Counts the sign patterns by their doubled rank sum.
double exact_p_value(const Ranked& ranked) {
  const int total = std::accumulate(ranked.doubled.begin(), ranked.doubled.end(), 0);
  std::vector<double> patterns(static_cast<std::size_t>(total) + 1);
  patterns[0] = 1;
  for (const int step : ranked.doubled) {
    for (int sum = total; sum >= step; --sum) {
      patterns[static_cast<std::size_t>(sum)] += patterns[static_cast<std::size_t>(sum - step)];
    }
  }
  const int smaller = std::min(ranked.positive, total - ranked.positive);
  const double tail = std::accumulate(patterns.begin(), patterns.begin() + smaller + 1, 0.0);
  return std::min(1.0, 2 * std::ldexp(tail, -static_cast<int>(ranked.doubled.size())));
}

double normal_p_value(const Ranked& ranked) {
  const auto n = static_cast<double>(ranked.doubled.size());
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - ranked.tie_correction / 48;
  const double distance = std::fabs(ranked.positive / 2.0 - n * (n + 1) / 4);
  return std::erfc(std::max(0.0, distance - 0.5) / std::sqrt(2 * variance));
}

}  // namespace

double wilcoxon_signed_rank(std::span<const double> differences) {
  for (const double d : differences) {
    if (!std::isfinite(d)) throw std::invalid_argument(fmt::format("Wilcoxon: {}: expected a finite difference", d));
  }
  const Ranked ranked = rank({differences.begin(), differences.end()});
  if (ranked.doubled.empty()) return 1;
  return ranked.doubled.size() <= most_for_exact ? exact_p_value(ranked) : normal_p_value(ranked);
}

std::vector<double> holm(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - i) * p_values[order[i]]));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

}  // namespace textonbench
