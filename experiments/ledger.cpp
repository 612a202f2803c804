#include "experiments/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/claims_file.h"
#include "experiments/files.h"

namespace textonbench {

Ledger read_ledger(const std::filesystem::path& home, const ExemplarCatalog& exemplars, Profile profile) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path folder = home / "configs" / "claims";
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  Ledger ledger;
  ledger.claims = read_claims(files);
  for (const Claim& claim : ledger.claims) {
    if (!claim.test || ledger.plans.contains(claim.test->config)) continue;
    const std::filesystem::path config = home / "configs" / (claim.test->config + ".toml");
    if (std::filesystem::is_regular_file(config)) {
      ledger.plans.emplace(claim.test->config, make_plan(read_config(config, profile), exemplars));
    }
  }
  check_claims(ledger.claims, ledger.plans);
  return ledger;
}

std::filesystem::path verdicts_file(const std::filesystem::path& results) {
  return results / "baseline" / "claims.json";
}

Verdicts read_verdicts(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return {};
  std::ifstream in(file);
  try {
    Verdicts verdicts;
    const nlohmann::json document = nlohmann::json::parse(in);
    for (const auto& [id, name] : document.at("claims").items()) {
      verdicts.emplace(id, verdict_of(name.get<std::string>()));
    }
    return verdicts;
  } catch (const std::exception& error) {
    throw std::invalid_argument(
        fmt::format("{}: expected {{\"claims\": {{ID: VERDICT, …}}}}: {}", file.string(), error.what()));
  }
}

void write_verdicts(const std::filesystem::path& file, const Verdicts& verdicts) {
  nlohmann::ordered_json claims = nlohmann::ordered_json::object();
  for (const auto& [id, verdict] : verdicts) claims[id] = verdict_name(verdict);
  std::filesystem::create_directories(file.parent_path());
  write_atomically(file, nlohmann::ordered_json{{"claims", claims}}.dump(2) + "\n");
}

Verdicts verdicts_of(const std::vector<ClaimOutcome>& outcomes) {
  Verdicts verdicts;
  for (const ClaimOutcome& outcome : outcomes) verdicts.emplace(outcome.claim->id, outcome.verdict);
  return verdicts;
}

std::vector<VerdictChange> changes_since(const Verdicts& recorded, const std::vector<ClaimOutcome>& outcomes) {
  std::vector<VerdictChange> changes;
  for (const ClaimOutcome& outcome : outcomes) {
    const auto before = recorded.find(outcome.claim->id);
    if (before != recorded.end() && before->second != outcome.verdict) {
      changes.push_back({outcome.claim->id, before->second, outcome.verdict});
    }
  }
  return changes;
}

}  // namespace textonbench
