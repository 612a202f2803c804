#include "experiments/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/cli/table.h"
#include "experiments/ledger.h"
#include "experiments/provenance.h"

namespace textonbench::cli {
namespace {

using Json = nlohmann::ordered_json;

struct ClaimsOptions {
  std::string paper, id, verdict;
  Profile profile = Profile::quick;
  bool json = false;
};

/// The first `most` letters, cut between words.
std::string shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  const std::size_t cut = text.rfind(' ', most);
  return cut == std::string::npos ? text : text.substr(0, cut) + " …";
}

std::string in_words(const Estimate& measured) {
  return fmt::format("{:.4g} [{:.4g}, {:.4g}]", measured.value, measured.low, measured.high);
}

/// Claims that the options ask for. Throws std::invalid_argument when a filter names what no claim has.
std::vector<ClaimOutcome> chosen(std::vector<ClaimOutcome> outcomes, const ClaimsOptions& options) {
  const auto keep = [&](const std::string& wanted, const char* option, const auto& value_of) {
    if (wanted.empty()) return;
    std::vector<std::string_view> known;
    known.reserve(outcomes.size());
    for (const ClaimOutcome& outcome : outcomes) known.push_back(value_of(outcome));
    if (std::ranges::find(known, wanted) == known.end()) {
      throw std::invalid_argument(fmt::format("{}: no claim has \"{}\"{} (textonbench list claims)", option, wanted,
                                              did_you_mean(wanted, known)));
    }
    std::erase_if(outcomes, [&](const ClaimOutcome& outcome) { return value_of(outcome) != wanted; });
  };
  keep(options.paper, "--paper", [](const ClaimOutcome& o) -> std::string_view { return o.claim->paper; });
  keep(options.id, "--id", [](const ClaimOutcome& o) -> std::string_view { return o.claim->id; });
  if (!options.verdict.empty()) {
    const ClaimVerdict wanted = verdict_of(options.verdict);
    std::erase_if(outcomes, [&](const ClaimOutcome& outcome) { return outcome.verdict != wanted; });
  }
  return outcomes;
}

std::vector<std::pair<std::string_view, std::size_t>> counts_of(const std::vector<ClaimOutcome>& outcomes) {
  std::vector<std::pair<std::string_view, std::size_t>> counts;
  for (const ClaimVerdict verdict : all_verdicts) {
    counts.emplace_back(verdict_name(verdict),
                        static_cast<std::size_t>(std::ranges::count(outcomes, verdict, &ClaimOutcome::verdict)));
  }
  return counts;
}

void print_ledger_json(const std::vector<ClaimOutcome>& outcomes, const std::vector<VerdictChange>& changes) {
  Json claims = Json::array();
  for (const ClaimOutcome& o : outcomes) {
    Json interval = nullptr;
    if (o.measured) interval = {o.measured->low, o.measured->high};
    claims.push_back({{"id", o.claim->id},
                      {"paper", o.claim->paper},
                      {"where", o.claim->where},
                      {"statement", o.claim->statement},
                      {"kind", o.claim->kind},
                      {"verdict", verdict_name(o.verdict)},
                      {"paper_value", o.claim->paper_value},
                      {"measured", o.measured ? Json(o.measured->value) : Json(nullptr)},
                      {"interval", interval},
                      {"record", o.records.empty() ? Json(nullptr) : Json(o.records.front())},
                      {"records", o.records},
                      {"command", o.command},
                      {"reason", o.reason},
                      {"caveat", o.claim->caveat}});
  }
  Json counts = Json::object();
  for (const auto& [name, count] : counts_of(outcomes)) counts[std::string(name)] = count;
  Json worse = Json::array();
  for (const VerdictChange& change : changes) {
    if (!change.worse()) continue;
    worse.push_back({{"id", change.id}, {"before", verdict_name(change.before)}, {"now", verdict_name(change.now)}});
  }
  print_json({{"claims", claims}, {"counts", counts}, {"worse", worse}});
}

void print_ledger(const std::vector<ClaimOutcome>& outcomes) {
  std::vector<std::vector<std::string>> rows;
  for (const ClaimOutcome& o : outcomes) {
    std::string record = o.records.empty() ? "" : o.records.front();
    if (o.records.size() > 1) record += fmt::format(" +{}", o.records.size() - 1);
    rows.push_back({o.claim->id, o.claim->paper + ", " + shortened(o.claim->where, 20),
                    shortened(o.claim->statement, 60), shortened(o.claim->paper_value, 30),
                    o.measured ? in_words(*o.measured) : "", std::string(verdict_name(o.verdict)),
                    record.empty() ? o.reason : record});
  }
  print_table({{"ID"}, {"PLACE"}, {"CLAIM"}, {"PAPER"}, {"MEASURED [95 %]"}, {"VERDICT"}, {"RECORD OR REASON"}}, rows);
  fmt::print("\n{} claims:", outcomes.size());
  const char* separator = " ";
  for (const auto& [name, count] : counts_of(outcomes)) {
    fmt::print("{}{} {}", separator, count, name);
    separator = ", ";
  }
  fmt::print("\n");
}

int tell(const ClaimsOptions& options, const GlobalOptions& globals) {
  const std::filesystem::path home = home_folder();
  const Ledger ledger = read_ledger(home, ExemplarCatalog(home), options.profile);
  const ReadRecords read = ResultsFolder(globals.results).read();
  const std::vector<ClaimOutcome> outcomes =
      chosen(evaluate_claims(ledger.claims, ledger.plans, read.records), options);
  const std::vector<VerdictChange> changes = changes_since(read_verdicts(verdicts_file(globals.results)), outcomes);
  options.json ? print_ledger_json(outcomes, changes) : print_ledger(outcomes);
  for (const VerdictChange& change : changes) {
    if (change.worse()) {
      fmt::print(stderr, "{} is worse than recorded: {} (was {})\n", change.id, verdict_name(change.now),
                 verdict_name(change.before));
    } else if (change.now == ClaimVerdict::not_run && !globals.quiet) {
      fmt::print(stderr, "warning: {} is no longer run (was {})\n", change.id, verdict_name(change.before));
    }
  }
  return std::ranges::any_of(changes, &VerdictChange::worse) ? 1 : 0;
}

}  // namespace

Command claims_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<ClaimsOptions>();
  CLI::App* command = app.add_subcommand("claims", "Hold the papers' claims against recorded runs");
  command->add_option("--paper", options->paper, "Only those of one paper (\"Lectures 2022\")");
  command->add_option("--id", options->id, "Only this one (S02)");
  command->add_option("--verdict", options->verdict, "Only those of one verdict (\"deviates\")");
  add_profile_option(*command, &options->profile);
  command->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*command, "  textonbench run lectures2022/claims && textonbench claims --paper \"Lectures 2022\"");
  return {command, [options, &globals] { return tell(*options, globals); }};
}

}  // namespace textonbench::cli
