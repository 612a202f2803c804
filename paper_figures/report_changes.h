// What became better or worse since the committed baseline.
#pragma once

#include <string>

#include "experiments/record.h"

namespace textonbench {

/// Section that compares results/baseline with the results (experiments/compare.h), metric by metric and, where methods
/// disagree, method by method. Empty without a baseline; where the two cannot be compared the section says why.
std::string changes_html(const ResultsFolder& results);

}  // namespace textonbench
