#include "experiments/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/execute.h"
#include "experiments/provenance.h"

namespace textonbench::history_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

PlannedRun make_run(std::uint64_t seed, const std::string& phase = "added") {
  PlannedRun run;
  run.spec.method = "rpn";
  run.spec.params = {{"component", "periodic"}, {"phase", phase}};
  run.spec.exemplar = "ring";
  run.spec.exemplar_sha256 = "abc";
  run.spec.seed = seed;
  run.spec.samples = 2;
  run.spec.metrics = {"rme"};
  run.id = run_id(run.spec);
  return run;
}

Record make_record(const PlannedRun& run, const std::string& status = "ok", double seconds = 1) {
  Record record = unsuccessful_record(run.spec, status, status == "ok" ? "" : "it rained");
  record["exemplar"] = {{"width", 10}, {"height", 20}, {"channels", 1}};
  record["time"]["wall_seconds"] = seconds;
  return record;
}

TEST(HistoryTest, SuccessesAndRefusalsAreReusedAndFailuresTriedAgain) {
  const History history({make_record(make_run(1)), make_record(make_run(2), "refused"),
                         make_record(make_run(3), "failed"), make_record(make_run(4), "failed"),
                         make_record(make_run(4)), make_record(make_run(5)), make_record(make_run(5), "failed")});
  EXPECT_TRUE(history.is_reusable(make_run(1).id));
  EXPECT_TRUE(history.is_reusable(make_run(2).id));
  EXPECT_FALSE(history.is_reusable(make_run(3).id));
  EXPECT_TRUE(history.is_reusable(make_run(4).id));
  EXPECT_TRUE(history.is_reusable(make_run(5).id)) << "an earlier success stands";
  EXPECT_FALSE(history.is_reusable(make_run(6).id));
  EXPECT_EQ(history.why_run(make_run(3)), "an earlier run failed: it rained");
}

TEST(HistoryTest, TellsWhereARunDiffersFromTheNearestRecordedOne) {
  const History history({make_record(make_run(1)), make_record(make_run(2, "replaced"))});
  EXPECT_EQ(history.why_run(make_run(1, "added and replaced")),
            "never run: differs from the nearest recorded run in params.phase (\"added\" -> \"added and replaced\")");
  PlannedRun other = make_run(2, "replaced");
  other.spec.samples = 9;
  other.spec.metrics = {"mean_error", "rme"};
  EXPECT_EQ(history.why_run(other),
            "never run: differs from the nearest recorded run in metrics ([\"rme\"] -> [\"mean_error\",\"rme\"]), "
            "samples (2 -> 9)");
  other.spec.exemplar = "grass";
  EXPECT_EQ(history.why_run(other), "never run: no record of rpn on grass");
}

TEST(HistoryTest, TellsAnotherCodeVersion) {
  Record record = make_record(make_run(1));
  record["id"] = "0123456789abcdef";
  record["provenance"]["code_version"] = "beef";
  EXPECT_EQ(History(std::vector<Record>{record}).why_run(make_run(1)),
            "recorded under another code version: code_version (beef -> current)");
  record["spec"]["exemplar_sha256"] = "of the procedure before";
  EXPECT_THAT(History(std::vector<Record>{record}).why_run(make_run(1)),
              AllOf(HasSubstr("never run"), HasSubstr("exemplar_sha256 (")));
  record["spec"]["seed"] = 7;
  EXPECT_THAT(History(std::vector<Record>{record}).why_run(make_run(1)),
              AllOf(HasSubstr("never run"), HasSubstr("seed (7 -> 1)")));
}

TEST(HistoryTest, EstimatesTimeFromThePixelsOfTheSameMethod) {
  // 10 x 20 pixels of 2 samples: 400 pixels; the median takes 2 seconds.
  const History history({make_record(make_run(1), "ok", 1), make_record(make_run(2), "ok", 2),
                         make_record(make_run(3), "ok", 90), make_record(make_run(4), "failed", 1000)});
  RunSpec spec = make_run(5).spec;
  EXPECT_DOUBLE_EQ(history.estimate_seconds(spec, {10, 20}).value(), 2);
  spec.size = {100, 40};
  spec.samples = 1;
  EXPECT_DOUBLE_EQ(history.estimate_seconds(spec, {10, 20}).value(), 20);
  spec.method = "adsn";
  EXPECT_FALSE(history.estimate_seconds(spec, {10, 20}));
  EXPECT_EQ(history.exemplar_size("abc"), (Extent{10, 20}));
  EXPECT_FALSE(history.exemplar_size("def"));
}

TEST(HistoryTest, RecordsOfOtherProgramsDoNoHarm) {
  const History history({{{"schema", 1}, {"id", "a"}, {"status", "ok"}},
                         {{"schema", 1}, {"id", "b"}, {"status", "ok"}, {"spec", 3}, {"time", "late"}},
                         {{"schema", 1}, {"id", "c"}, {"status", "ok"}, {"spec", {{"size", "large"}}}}});
  EXPECT_TRUE(history.is_reusable("b"));
  EXPECT_THAT(history.why_run(make_run(1)), HasSubstr("no record of rpn on ring"));
}

}  // namespace textonbench::history_test
