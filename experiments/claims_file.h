// configs/claims/<paper>.toml: the paper, and one [[claims]] table a claim.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "experiments/claims.h"

namespace textonbench {

/// Claims of all files, in file order. Throws ConfigError for an unknown or missing key, kind, metric or need, an
/// impossible range, a claim without test and needs, and an id that stands twice, be it in two files.
std::vector<Claim> read_claims(std::span<const std::filesystem::path> files);

}  // namespace textonbench
