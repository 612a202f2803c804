#include "experiments/statistics/bootstrap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "experiments/statistics/student.h"

namespace textonbench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t fewest_units = 4;

void require_usable(const Levels& levels, double confidence, int replicates) {
  if (levels.empty()) throw std::invalid_argument("bootstrap: there is no exemplar to average over");
  for (const std::vector<double>& seeds : levels) {
    if (seeds.empty()) throw std::invalid_argument("bootstrap: an exemplar has no number");
    for (const double x : seeds) {
      if (!std::isfinite(x)) throw std::invalid_argument(fmt::format("bootstrap: {}: expected a finite number", x));
    }
  }
  if (!(confidence > 0 && confidence < 1)) {
    throw std::invalid_argument(fmt::format("bootstrap: confidence {}: expected between 0 and 1", confidence));
  }
  if (replicates < 100) {
    throw std::invalid_argument(fmt::format("bootstrap: {} replicates: expected at least 100", replicates));
  }
}

double mean(std::span<const double> values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

struct Moments {
  double mean = 0, error = 0;  ///< `error` is the standard error of the mean
};

/// Spreads at the level of rounding count as none.
Moments moments(std::span<const double> units) {
  const double center = mean(units);
  double squares = 0, largest = 0;
  for (const double x : units) {
    squares += (x - center) * (x - center);
    largest = std::max(largest, std::fabs(x));
  }
  const auto n = static_cast<double>(units.size());
  const double error = units.size() > 1 ? std::sqrt(squares / (n * (n - 1))) : infinity;
  return {center, error <= 1e-14 * largest ? 0 : error};
}

/// A single exemplar's seeds become units of one number each.
Levels with_units_on_top(const Levels& levels) {
  if (levels.size() > 1) return levels;
  Levels units;
  for (const double x : levels.front()) units.push_back({x});
  return units;
}

/// Sorted t*; a replicate without spread is infinitely far on its side.
std::vector<double> studentized_replicates(const Levels& levels, double center, int replicates, Seed seed) {
  RandomSequence random(Stream(seed).child("bootstrap"));
  std::vector<double> result, units(levels.size());
  result.reserve(static_cast<std::size_t>(replicates));
  for (int b = 0; b < replicates; ++b) {
    for (double& unit : units) {
      const std::vector<double>& seeds = levels[random.below(levels.size())];
      if (seeds.size() == 1) {
        unit = seeds.front();
        continue;
      }
      double sum = 0;
      for (std::size_t i = 0; i < seeds.size(); ++i) sum += seeds[random.below(seeds.size())];
      unit = sum / static_cast<double>(seeds.size());
    }
    const Moments m = moments(units);
    result.push_back(m.error > 0 ? (m.mean - center) / m.error : std::copysign(infinity, m.mean - center));
  }
  std::sort(result.begin(), result.end());
  return result;
}

/// Linear interpolation between order statistics; infinite as soon as one of them is.
double quantile(const std::vector<double>& sorted, double p) {
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const double low = sorted[below], high = sorted[std::min(below + 1, sorted.size() - 1)];
  if (!std::isfinite(low) || !std::isfinite(high)) return std::isfinite(low) ? high : low;
  return low + (place - static_cast<double>(below)) * (high - low);
}

/// Two-sided and equal-tailed, so that it is below α just where the interval of confidence 1 − α excludes zero.
double p_value_of(const std::vector<double>& sorted, double t) {
  const auto below = std::upper_bound(sorted.begin(), sorted.end(), t) - sorted.begin();
  const auto above = sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), t);
  const auto tail = static_cast<double>(std::min(below, above));
  return std::min(1.0, 2 * (tail + 1) / static_cast<double>(sorted.size() + 1));
}

}  // namespace

TestedMean test_mean(const Levels& given, double confidence, int replicates, Seed seed) {
  require_usable(given, confidence, replicates);
  const Levels levels = with_units_on_top(given);
  std::vector<double> units;
  units.reserve(levels.size());
  for (const std::vector<double>& seeds : levels) units.push_back(mean(seeds));
  const auto [value, error] = moments(units);
  if (units.size() == 1) return {{value, -infinity, infinity}, 1};
  if (error == 0) return {{value, value, value}, value == 0 ? 1.0 : 0.0};

  const double alpha = 1 - confidence;
  if (units.size() >= fewest_units) {
    const std::vector<double> t = studentized_replicates(levels, value, replicates, seed);
    const double low = quantile(t, alpha / 2), high = quantile(t, 1 - alpha / 2);
    if (std::isfinite(low) && std::isfinite(high)) {
      return {{value, value - error * high, value - error * low}, p_value_of(t, value / error)};
    }
  }
  const auto degrees = static_cast<int>(units.size()) - 1;
  const double reach = error * student_quantile(1 - alpha / 2, degrees);
  return {{value, value - reach, value + reach}, 2 * (1 - student_cdf(std::fabs(value) / error, degrees))};
}

Estimate bootstrap_mean(const Levels& levels, double confidence, int replicates, Seed seed) {
  return test_mean(levels, confidence, replicates, seed).estimate;
}

}  // namespace textonbench
