// Claims of papers, each held against records by a test that was fixed beforehand.
//
// A test names numbers of a config's runs and the range in which their mean must lie. The mean's 95 % interval is that
// of the two-level bootstrap (exemplars, then seeds within an exemplar; statistics/bootstrap.h). Wholly inside the
// range the claim is reproduced, wholly outside it deviates, and across a limit the measurement cannot tell.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/config.h"
#include "experiments/plan.h"
#include "experiments/record.h"
#include "experiments/statistics/bootstrap.h"

namespace textonbench {

/// From best to worst; not_run is apart.
enum class ClaimVerdict { reproduced, reproduced_with_caveat, inconclusive, deviates, not_run };
inline constexpr ClaimVerdict all_verdicts[] = {ClaimVerdict::reproduced, ClaimVerdict::reproduced_with_caveat,
                                                ClaimVerdict::inconclusive, ClaimVerdict::deviates,
                                                ClaimVerdict::not_run};
/// "reproduced with a caveat".
std::string_view verdict_name(ClaimVerdict verdict);
/// Throws std::invalid_argument for another text, with the nearest verdict.
ClaimVerdict verdict_of(std::string_view name);

/// What the seeds of an exemplar come to, when a claim is about them together: their mean, their standard deviation or
/// their least number.
enum class OverSeeds { each, mean, deviation, least };

/// Numbers of the runs of one [[runs]] table: {run = "rpn", metric = "rme", exemplar = "ring", phase = "added"}.
struct ClaimSelection {
  SourcePlace place;
  std::string run, metric;
  bool floor = false;                            ///< part = "floor": the metric's floor instead of its value
  OverSeeds over_seeds = OverSeeds::each;        ///< over_seeds = "mean", "deviation" or "least"
  std::map<std::string, ParamValue> conditions;  ///< on exemplar, seed, or a parameter of the method
  std::map<std::string, SourcePlace> places;
};

enum class CombinePair { difference, ratio };

/// Limits belong to the range.
struct ExpectedRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

struct ClaimTest {
  std::string config;  ///< "lectures2022/claims"
  SourcePlace config_place;
  ClaimSelection measure;
  /// Measured beside it and combined pairwise, on the same exemplar and seed, or on the same exemplar where both are
  /// taken over seeds: measure − against, or measure / against.
  std::optional<ClaimSelection> against;
  CombinePair combine = CombinePair::difference;
  ExpectedRange expect;
};

struct Claim {
  SourcePlace place;
  std::string paper, id, where, statement;
  std::string kind;         ///< identity, quantitative, ordinal, timing or setting
  std::string paper_value;  ///< the paper's number, or what it asserts
  std::string how;          ///< the test in words
  std::string caveat;       ///< what the test leaves open; the best verdict is then reproduced_with_caveat
  std::string note;
  std::vector<std::string> needs;  ///< what a test needs beyond records: "method:sot", "metric:verbatim_copy", "gpu"
  std::optional<ClaimTest> test;
};

/// What a claim came to.
struct ClaimOutcome {
  const Claim* claim = nullptr;
  ClaimVerdict verdict = ClaimVerdict::not_run;
  /// Why it was not run, or what the number leaves out.
  std::string reason;
  std::optional<Estimate> measured;
  std::vector<std::string> records;  ///< ids, in plan order
  std::string command;               ///< makes the records; empty without a test
};

/// Plan of each config that claims name.
using ClaimPlans = std::map<std::string, Plan>;

/// Throws ConfigError for a test whose config is not among `plans`, or that names a run, metric or condition that its
/// plan does not have.
void check_claims(std::span<const Claim> claims, const ClaimPlans& plans);

/// One outcome a claim, in order: a pure function of its arguments. The ratio of a pair is averaged by its logarithm;
/// several runs of one exemplar and seed count by their mean.
std::vector<ClaimOutcome> evaluate_claims(std::span<const Claim> claims, const ClaimPlans& plans,
                                          const std::vector<Record>& records);

}  // namespace textonbench
