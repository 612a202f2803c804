#include "experiments/margins.h"

#include <array>

namespace textonbench {
namespace {

constexpr double rounding = 1e-4;
constexpr Margin usual{0.01, /*relative=*/true, rounding, Comparability::sampled};

struct Exception {
  std::string_view metric;
  Margin margin;
};

constexpr std::array exceptions{
    // Near zero whenever the law is Gaussian, so a relative change says nothing.
    Exception{"skewness", {0.05, false, 0, Comparability::sampled}},
    Exception{"excess_kurtosis", {0.05, false, 0, Comparability::sampled}},
    // Two sweeps on one machine differ by some percent, whatever their own noise.
    Exception{"analyze_seconds", {0.05, true, 0, Comparability::timed}},
    Exception{"synthesize_seconds", {0.05, true, 0, Comparability::timed}},
    Exception{"ns_per_pixel", {0.05, true, 0, Comparability::timed}},
    Exception{"model_bytes", {0.01, true, 0, Comparability::exact}},
    Exception{"operations_per_pixel", {0.01, true, 0, Comparability::exact}},
};

}  // namespace

Margin margin_of(const MetricEntry& metric) {
  for (const Exception& exception : exceptions) {
    if (exception.metric == metric.name) return exception.margin;
  }
  return usual;
}

}  // namespace textonbench
