// How much a metric may change and still count as the same.
#pragma once

#include "experiments/metrics/metric.h"

namespace textonbench {

/// What kind of number a metric is, as far as comparing goes.
enum class Comparability {
  sampled,  ///< varies with exemplar and seed
  exact,    ///< a count that the same code repeats: no interval
  timed     ///< depends on the machine, too
};

struct Margin {
  /// Changes below are none: relative to the mean of the two magnitudes, or absolute in the metric's unit.
  double size;
  bool relative;
  /// Least magnitude that a relative change refers to, in the metric's unit: rounding errors of a metric that is zero
  /// in theory are no change.
  double resolution;
  Comparability kind;
};

Margin margin_of(const MetricEntry& metric);

}  // namespace textonbench
