// Pages of the report that hold all methods against each other on one exemplar, at equal cost.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "paper_figures/report_runs.h"

namespace textonbench {

/// Writes report/exemplar_NAME.html below the results folder for every exemplar of which two methods or more can be
/// compared (equal_cost.h), self-contained like the report beside it, to whose records it links. Pages of exemplars
/// that have none any more are removed. Returns the pages' names by exemplar. Throws std::runtime_error when a template
/// is missing or a page cannot be written.
std::map<std::string, std::string> write_exemplar_pages(const std::vector<ReportRun>& runs,
                                                        const ResultsFolder& results);

}  // namespace textonbench
