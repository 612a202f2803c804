// The claims of all papers with what decides them, and the verdicts that were recorded.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/claims.h"
#include "experiments/exemplars.h"

namespace textonbench {

struct Ledger {
  std::vector<Claim> claims;
  ClaimPlans plans;
};

/// Every configs/claims/*.toml below `home`, checked, with the plans of the configs that they name. Throws ConfigError.
Ledger read_ledger(const std::filesystem::path& home, const ExemplarCatalog& exemplars, Profile profile);

/// Verdicts by claim: {"claims": {"S02": "reproduced", …}}.
using Verdicts = std::map<std::string, ClaimVerdict>;

/// results/baseline/claims.json below a results folder.
std::filesystem::path verdicts_file(const std::filesystem::path& results);
/// A missing file is no verdict. Throws std::invalid_argument naming the file for anything else than the above.
Verdicts read_verdicts(const std::filesystem::path& file);
/// Creates the folder if need be. Throws std::runtime_error naming the file.
void write_verdicts(const std::filesystem::path& file, const Verdicts& verdicts);
/// Of all outcomes, those not run too.
Verdicts verdicts_of(const std::vector<ClaimOutcome>& outcomes);

/// A verdict that is not the recorded one. One that is no longer run is no worse: it is not known.
struct VerdictChange {
  std::string id;
  ClaimVerdict before, now;
  bool worse() const { return before != ClaimVerdict::not_run && now != ClaimVerdict::not_run && now > before; }
};
/// In the order of `outcomes`; claims that have no recorded verdict are left out.
std::vector<VerdictChange> changes_since(const Verdicts& recorded, const std::vector<ClaimOutcome>& outcomes);

}  // namespace textonbench
