// The page of the report that holds the papers' claims against what was measured.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/claims.h"

namespace textonbench {

/// Where the page stands below a results folder: report/claims.html.
std::filesystem::path ledger_page(const ResultsFolder& results);

/// Writes the page, self-contained like the report beside it, to whose records it links. Returns its path. Throws
/// std::runtime_error when a template is missing or the page cannot be written.
std::filesystem::path write_ledger_page(const std::vector<ClaimOutcome>& outcomes, const ResultsFolder& results);

}  // namespace textonbench
