// Where a measured curve comes down to a level.
#pragma once

#include <span>

#include "experiments/statistics/bootstrap.h"

namespace textonbench {

/// y > 0 with its standard error, measured at x > 0.
struct MeasuredPoint {
  double x = 0, y = 0, error = 0;
};

/// The x from which on the curve stays at or below `level`, between two points by a line in log x and log y; 0 where it
/// is there at all points, infinite where it is above at the last. The interval holds the crossings of the curves
/// y exp(± 1.96 error / y), 95 % bounds of each point: it takes the errors for those of one curve that is moved as a
/// whole. Points by ascending x. Throws std::invalid_argument without points, for x that do not ascend and for numbers
/// that are not positive and finite.
Estimate log_log_crossing(std::span<const MeasuredPoint> points, double level);

}  // namespace textonbench
