#include "experiments/compare.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "experiments/pairing.h"
#include "tests/experiments/synthetic_results.h"
#include "tests/sanitizer.h"
#include "tests/temporary_folder.h"

namespace textonbench::compare_test {

using testing::AllOf;
using testing::HasSubstr;

const MetricComparison& row(const Comparison& comparison, std::string_view metric) {
  return *std::find_if(comparison.metrics.begin(), comparison.metrics.end(),
                       [&](const MetricComparison& m) { return m.metric == metric; });
}

Verdict verdict(const Comparison& comparison, std::string_view metric) { return row(comparison, metric).verdict; }

/// A set of errors near 0.5 and times near 20 ns, differing by exemplar, with relative noise `noise` of its own for
/// each `draw`. Quality and time are multiplied by the factors.
struct Sweep {
  std::uint64_t draw = 1;
  double noise = 0.01, quality = 1, time = 1;
  int samples = 3;
  std::string cpu = "Example 3000", method = "adsn";

  ResultSet make() const {
    RandomSequence random(Stream(Seed{draw}).child("sweep"));
    const auto around = [&](double center) { return center * (1 + noise * random.normal()); };
    return make_synthetic_set([&](SyntheticRun& run) {
      const double level = 0.4 + 0.02 * static_cast<double>(run.exemplar.size() + run.exemplar.back() % 7);
      run.method = method;
      run.samples = samples;
      run.cpu = cpu;
      run.metrics = {{"rme", quality * around(level)},
                     {"patch_distance", quality * around(level / 3)},
                     {"log_spectral_distance", quality * around(3 * level)},
                     {"rme_printed", around(level)},
                     {"excess_kurtosis", 10 * noise * random.normal()},
                     {"ns_per_pixel", time * around(20)},
                     {"model_bytes", 4096}};
    });
  }
};

ResultSet merged(ResultSet a, const ResultSet& b) {
  a.runs.insert(b.runs.begin(), b.runs.end());
  return a;
}

TEST(Compare, ASetIsTheSameAsItself) {
  const ResultSet set = Sweep{}.make();
  const Comparison comparison = compare(set, set);
  EXPECT_EQ(comparison.pairs, 52U);
  EXPECT_EQ(comparison.regressions(), 0U);
  EXPECT_EQ(verdict(comparison, "rme"), Verdict::same);
  EXPECT_EQ(verdict(comparison, "model_bytes"), Verdict::same);
  EXPECT_EQ(verdict(comparison, "ns_per_pixel"), Verdict::same);
  EXPECT_EQ(verdict(comparison, "skewness"), Verdict::not_compared);
}

TEST(Compare, CatchesALossOfTwoPercent) {
  const Comparison comparison = compare(Sweep{.draw = 1}.make(), Sweep{.draw = 2, .quality = 1.02}.make());
  const MetricComparison& rme = row(comparison, "rme");
  EXPECT_EQ(rme.verdict, Verdict::worse);
  EXPECT_NEAR(rme.change.value, 0.02, 0.006);
  EXPECT_LT(rme.change.low, 0.0198);
  EXPECT_GT(rme.change.high, 0.0198);
  EXPECT_EQ(verdict(comparison, "patch_distance"), Verdict::worse);
  EXPECT_EQ(verdict(comparison, "model_bytes"), Verdict::same);
  EXPECT_EQ(comparison.regressions(), 3U);
  const Comparison back = compare(Sweep{.draw = 2, .quality = 1.02}.make(), Sweep{.draw = 1}.make());
  EXPECT_EQ(verdict(back, "rme"), Verdict::better);
  EXPECT_EQ(back.regressions(), 0U);
}

TEST(Compare, CatchesASlowdownOfTenPercent) {
  const Comparison comparison = compare(Sweep{.draw = 1}.make(), Sweep{.draw = 2, .time = 1.1}.make());
  EXPECT_EQ(verdict(comparison, "ns_per_pixel"), Verdict::worse);
  EXPECT_EQ(comparison.regressions(), 1U);
  // Within the margin of 5 %.
  EXPECT_EQ(verdict(compare(Sweep{.draw = 1}.make(), Sweep{.draw = 2, .time = 1.03}.make()), "ns_per_pixel"),
            Verdict::same);
}

TEST(Compare, ALossOfOneMethodIsNotHiddenByAnother) {
  const ResultSet before =
      merged(Sweep{.draw = 1, .noise = 0.002}.make(), Sweep{.draw = 2, .noise = 0.002, .method = "rpn"}.make());
  const ResultSet after = merged(Sweep{.draw = 3, .noise = 0.002}.make(),
                                 Sweep{.draw = 4, .noise = 0.002, .quality = 1.015, .method = "rpn"}.make());
  const MetricComparison rme = row(compare(before, after), "rme");
  ASSERT_EQ(rme.methods.size(), 2U);
  EXPECT_EQ(rme.methods[0].verdict, Verdict::same);
  EXPECT_EQ(rme.methods[1].verdict, Verdict::worse);
  EXPECT_LT(rme.change.high, rme.margin);
  EXPECT_EQ(rme.verdict, Verdict::worse);
  EXPECT_EQ(rme.reason, "worse for rpn");
}

TEST(Compare, NoiseAloneRaisesFewFalseAlarms) {
  if (sanitized) GTEST_SKIP() << "takes long in a build with a sanitizer";
  int alarms = 0, regressions = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Comparison comparison =
        compare(Sweep{.draw = 1000 + 2 * i, .noise = 0.05}.make(), Sweep{.draw = 1001 + 2 * i, .noise = 0.05}.make(),
                {.replicates = 1000, .seed = Seed{i}});
    const bool alarm = std::any_of(comparison.metrics.begin(), comparison.metrics.end(), [](const MetricComparison& m) {
      return m.verdict == Verdict::worse || m.verdict == Verdict::better || m.verdict == Verdict::changed;
    });
    alarms += alarm ? 1 : 0;
    regressions += comparison.regressions() > 0 ? 1 : 0;
  }
  RecordProperty("alarms", alarms);
  RecordProperty("regressions", regressions);
  // At a rate of 5 % a comparison, P(more than 20 of 200) = 0.1 %.
  EXPECT_LE(alarms, 20);
  EXPECT_LE(regressions, alarms);
}

TEST(Compare, RoundingErrorsOfAZeroAreNoChange) {
  const auto with_rme = [](double value) {
    return make_synthetic_set([&](SyntheticRun& run) { run.metrics = {{"rme", value}}; });
  };
  EXPECT_EQ(verdict(compare(with_rme(1e-8), with_rme(3e-8)), "rme"), Verdict::same);
  EXPECT_EQ(verdict(compare(with_rme(1e-8), with_rme(3e-3)), "rme"), Verdict::worse);
  EXPECT_EQ(verdict(compare(with_rme(0), with_rme(0)), "rme"), Verdict::same);
}

TEST(Compare, KindsOfMetrics) {
  const auto with = [](double kurtosis, double printed, double bytes) {
    return make_synthetic_set([&](SyntheticRun& run) {
      const double tick = 1e-4 * static_cast<double>(run.seed);
      run.metrics = {{"excess_kurtosis", kurtosis + tick}, {"rme_printed", printed + tick}, {"model_bytes", bytes}};
    });
  };
  // Nearer to zero is better, on either side; neither larger nor smaller is, for the printed formula.
  const Comparison comparison = compare(with(-0.3, 0.5, 1000), with(0.1, 0.6, 1100));
  EXPECT_EQ(verdict(comparison, "excess_kurtosis"), Verdict::better);
  EXPECT_EQ(verdict(comparison, "rme_printed"), Verdict::changed);
  EXPECT_EQ(verdict(comparison, "model_bytes"), Verdict::worse);
  EXPECT_EQ(comparison.regressions(), 1U);
  EXPECT_EQ(verdict(compare(with(0.1, 0.5, 1000), with(-0.11, 0.5, 1000)), "excess_kurtosis"), Verdict::same);
}

TEST(Compare, OneExemplarDecidesNothingButIdentity) {
  const auto single = [](double value) {
    ResultSet set;
    const Record record = make_synthetic_record({.metrics = {{"rme", value}}});
    set.runs[computation(record)] = record;
    return set;
  };
  EXPECT_EQ(verdict(compare(single(0.5), single(0.5)), "rme"), Verdict::same);
  const Comparison comparison = compare(single(0.5), single(0.9));
  EXPECT_EQ(verdict(comparison, "rme"), Verdict::inconclusive);
  const nlohmann::ordered_json json = to_json(comparison);
  EXPECT_EQ(json["metrics"][0]["interval"], nlohmann::ordered_json({nullptr, nullptr}));
}

TEST(Compare, TimesNeedTheSameMachineAndNineRepetitions) {
  const Comparison other = compare(Sweep{}.make(), Sweep{.cpu = "Example 4000"}.make());
  EXPECT_EQ(verdict(other, "ns_per_pixel"), Verdict::not_compared);
  EXPECT_THAT(row(other, "ns_per_pixel").reason,
              AllOf(HasSubstr("other machine"), HasSubstr("Example 3000"), HasSubstr("Example 4000")));
  EXPECT_EQ(verdict(other, "rme"), Verdict::same);

  const Comparison few = compare(Sweep{.samples = 2}.make(), Sweep{.samples = 2}.make());
  EXPECT_EQ(verdict(few, "ns_per_pixel"), Verdict::not_compared);
  EXPECT_EQ(row(few, "ns_per_pixel").reason, "8 repetitions: expected at least 9");
}

TEST(Compare, TimesAreRatiosToTheFloorOfTheRun) {
  const auto timed = [](double time, double floor) {
    ResultSet set = make_synthetic_set([&](SyntheticRun& run) { run.metrics = {{"ns_per_pixel", time}}; });
    for (auto& [computation, record] : set.runs) record["metrics"]["ns_per_pixel"]["floor"] = floor;
    return set;
  };
  // The machine was half as fast.
  EXPECT_EQ(verdict(compare(timed(20, 5), timed(40, 10)), "ns_per_pixel"), Verdict::same);
  EXPECT_EQ(verdict(compare(timed(20, 5), timed(20, 4)), "ns_per_pixel"), Verdict::worse);
}

TEST(Compare, LostValuesAndFailedRunsAreRegressions) {
  const ResultSet before = Sweep{}.make();
  ResultSet after = before;
  after.runs.begin()->second["metrics"]["rme"]["value"] = nullptr;
  const Comparison lost = compare(before, after);
  EXPECT_EQ(verdict(lost, "rme"), Verdict::worse);
  EXPECT_EQ(row(lost, "rme").reason, "1 value lost");
  EXPECT_EQ(lost.regressions(), 1U);

  after = before;
  after.runs.begin()->second["status"] = "failed";
  after.runs.begin()->second["reason"] = "killed by SIGSEGV";
  const Comparison failed = compare(before, after);
  ASSERT_EQ(failed.newly_failed.size(), 1U);
  EXPECT_THAT(failed.newly_failed[0], HasSubstr("failed: killed by SIGSEGV"));
  EXPECT_EQ(failed.regressions(), 1U);
  EXPECT_EQ(compare(after, before).regressions(), 0U);
}

TEST(Compare, NoSharedRunIsExplained) {
  ResultSet elsewhere = make_synthetic_set([](SyntheticRun& run) {
    run.exemplar += "_other";
    run.seed += 10;
  });
  elsewhere.file = "elsewhere.jsonl";
  try {
    compare(Sweep{}.make(), elsewhere);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("synthetic.jsonl and elsewhere.jsonl share no run"),
                                    HasSubstr("exemplar: exemplar_0"), HasSubstr("seed: 1, 2, 3, 4 | 11")));
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("method: ")));
  }
}

TEST(ResultSet, ReadsFoldersAndFilesAndTellsDamage) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "records.jsonl";
  const Record good = make_synthetic_record({.metrics = {{"rme", 0.5}}});
  Record failed = good;
  failed["status"] = "failed";
  std::ofstream(file) << good.dump() << "\n{\"schema\":1,\"id\":\"cut\n" << failed.dump() << "\n{\"schema\":1}\n";
  for (const std::filesystem::path& given : {folder.path(), file}) {
    const ResultSet set = read_result_set(given);
    ASSERT_EQ(set.runs.size(), 1U);
    EXPECT_EQ(set.runs.begin()->second["status"], "ok") << "a later failure hides no result";
    ASSERT_EQ(set.bad_lines.size(), 2U);
    EXPECT_EQ(set.bad_lines[0].line, 2U);
    EXPECT_EQ(set.bad_lines[1].line, 4U);
  }
}

TEST(ResultSet, RefusesOtherSchemasAndEmptySets) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "records.jsonl";
  const auto message = [&](const std::filesystem::path& path) -> std::string {
    try {
      read_result_set(path);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message(folder.path() / "nowhere"), HasSubstr("no such file or folder"));
  EXPECT_THAT(message(folder.path()), HasSubstr("no records.jsonl in it"));
  std::ofstream(file) << "";
  EXPECT_THAT(message(file), HasSubstr("no usable record"));
  std::ofstream(file) << R"({"schema": 7, "provenance": {"version": "9.1"}})"
                      << "\n";
  EXPECT_THAT(message(file), AllOf(HasSubstr("records.jsonl:1: a record of schema 7, written by textonbench 9.1"),
                                   HasSubstr("reads schema 1"), HasSubstr("baseline update --reason")));
}

}  // namespace textonbench::compare_test
