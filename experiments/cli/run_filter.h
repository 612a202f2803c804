// `--filter`: the part of a plan that a user wants to run.
#pragma once

#include <string>
#include <vector>

#include "experiments/plan.h"

namespace textonbench::cli {

/// The runs for which every "key=pattern" of the comma-separated expression holds. Keys: method, exemplar, label (of
/// any [[runs]] table that asks for the run), seed, size, periodic, or a parameter's name; patterns may hold * and ?.
/// Throws std::invalid_argument for a term without "=", a key that no run has, and when nothing is left.
std::vector<PlannedRun> filter_runs(const Plan& plan, const std::string& expression);

}  // namespace textonbench::cli
