#include "experiments/cli/run_filter.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

namespace textonbench::cli {
namespace {

/// A run and what terms can be held against: a key may have several values (labels).
struct Candidate {
  const PlannedRun* run;
  std::multimap<std::string, std::string> traits;
};

std::vector<Candidate> candidates_of(const Plan& plan) {
  std::vector<Candidate> candidates;
  for (const PlannedRun& run : plan.runs) {
    Candidate candidate{&run,
                        {{"method", run.spec.method},
                         {"exemplar", run.spec.exemplar},
                         {"seed", std::to_string(run.spec.seed)},
                         {"size", fmt::format("{}x{}", run.spec.size.width, run.spec.size.height)},
                         {"periodic", run.spec.periodic ? "true" : "false"}}};
    for (const auto& [name, value] : options_of(run.spec)) candidate.traits.emplace(name, to_string(value));
    candidates.push_back(std::move(candidate));
  }
  for (const auto& [label, indices] : plan.by_label) {
    for (const std::size_t i : indices) candidates[i].traits.emplace("label", label);
  }
  return candidates;
}

void keep_matching(std::vector<Candidate>& candidates, const std::string& term) {
  const std::size_t equals = term.find('=');
  if (equals == std::string::npos) {
    throw std::invalid_argument(fmt::format("--filter: \"{}\": expected key=pattern", term));
  }
  const std::string key = term.substr(0, equals), pattern = term.substr(equals + 1);
  bool known = false;
  std::erase_if(candidates, [&](const Candidate& candidate) {
    const auto [first, last] = candidate.traits.equal_range(key);
    known = known || first != last;
    return std::none_of(first, last,
                        [&](const auto& trait) { return fnmatch(pattern.c_str(), trait.second.c_str(), 0) == 0; });
  });
  if (!known) {
    throw std::invalid_argument(fmt::format(
        "--filter: no run has \"{}\": expected method, exemplar, label, seed, size, periodic or a parameter", key));
  }
  if (candidates.empty()) throw std::invalid_argument(fmt::format("--filter: no run has {} like \"{}\"", key, pattern));
}

}  // namespace

std::vector<PlannedRun> filter_runs(const Plan& plan, const std::string& expression) {
  std::vector<Candidate> candidates = candidates_of(plan);
  std::istringstream terms(expression);
  for (std::string term; std::getline(terms, term, ',');) keep_matching(candidates, term);
  std::vector<PlannedRun> kept;
  kept.reserve(candidates.size());
  for (const Candidate& candidate : candidates) kept.push_back(*candidate.run);
  return kept;
}

}  // namespace textonbench::cli
