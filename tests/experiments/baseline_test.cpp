#include "experiments/baseline.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "experiments/compare.h"
#include "experiments/files.h"
#include "tests/experiments/synthetic_results.h"
#include "tests/temporary_folder.h"

namespace textonbench::baseline_test {

const std::string date = "2024-05-06T07:08:09Z";

class BaselineTest : public testing::Test {
 protected:
  static ResultSet make_set(double rme) {
    return make_synthetic_set([&](SyntheticRun& run) { run.metrics = {{"rme", rme}, {"model_bytes", 64}}; });
  }
  std::vector<Record> history() const {
    std::vector<Record> lines;
    std::ifstream in(folder() / "history.jsonl");
    for (std::string line; std::getline(in, line);) lines.push_back(Record::parse(line));
    return lines;
  }
  std::filesystem::path folder() const { return temporary_.path() / "results" / "baseline"; }

  TemporaryFolder temporary_;
};

TEST_F(BaselineTest, KeepsWhatIsComparedAndNoMore) {
  ResultSet results = make_set(0.5);
  for (auto& [computation, record] : results.runs) {
    record["pictures"] = {{"sample", {{"file", "pictures/0.png"}}}};
    record["spec"]["pictures"] = {"sample"};
  }
  const BaselineUpdate update = update_baseline(results, folder(), "first numbers", date);
  EXPECT_EQ(update.runs, 52U);
  EXPECT_EQ(update.failed + update.other_code, 0U);
  const ResultSet kept = read_result_set(folder());
  EXPECT_EQ(kept.runs.size(), 52U);
  const Record& record = kept.runs.begin()->second;
  EXPECT_FALSE(record.contains("pictures"));
  EXPECT_FALSE(record.contains("time"));
  EXPECT_EQ(record["spec"]["pictures"], Record::array());
  EXPECT_EQ(record["provenance"]["code_version"], results.runs.begin()->second["provenance"]["code_version"]);
  const Comparison comparison = compare(kept, results);
  EXPECT_EQ(comparison.pairs, 52U);
  EXPECT_EQ(comparison.regressions(), 0U);
}

TEST_F(BaselineTest, HistoryGrowsByALineAnUpdate) {
  update_baseline(make_set(0.5), folder(), "first numbers", date);
  update_baseline(make_set(0.25), folder(), "better \"analysis\"", date);
  const std::vector<Record> lines = history();
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["reason"], "first numbers");
  EXPECT_DOUBLE_EQ(lines[0]["metrics"]["rme"], 0.5);
  EXPECT_EQ(lines[1]["reason"], "better \"analysis\"");
  EXPECT_DOUBLE_EQ(lines[1]["metrics"]["rme"], 0.25);
  EXPECT_EQ(lines[1]["date"], date);
  EXPECT_EQ(lines[1]["git_commit"], "abc");
  EXPECT_EQ(lines[1]["runs"], 52);
  EXPECT_EQ(lines[1]["exemplars"], 13);
  EXPECT_EQ(lines[1]["methods"], 1);
  EXPECT_DOUBLE_EQ(*metric_number(read_result_set(folder()).runs.begin()->second, "rme", "value"), 0.25);
}

TEST_F(BaselineTest, SameResultsGiveTheSameBytes) {
  update_baseline(make_set(0.5), folder(), "first", date);
  const auto content = [&] {
    std::ifstream in(folder() / "records.jsonl");
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  const std::string first = content();
  update_baseline(make_set(0.5), folder(), "second", date);
  EXPECT_EQ(content(), first);
}

TEST_F(BaselineTest, LeavesOutFailedRunsAndOtherCode) {
  ResultSet results = make_set(0.5);
  auto run = results.runs.begin();
  run->second["status"] = "failed";
  ++run;
  run->second["provenance"]["code_version"] = "older";
  run->second["time"]["finished"] = "2023-01-01T00:00:00Z";
  const BaselineUpdate update = update_baseline(results, folder(), "some", date);
  EXPECT_EQ(update.failed, 1U);
  EXPECT_EQ(update.other_code, 1U);
  EXPECT_EQ(update.runs, 50U);
  EXPECT_EQ(read_result_set(folder()).runs.size(), 50U);
}

TEST_F(BaselineTest, RefusesABlankReasonAndAnEmptySet) {
  EXPECT_THROW(update_baseline(make_set(0.5), folder(), " \t\n", date), std::invalid_argument);
  ResultSet failed = make_set(0.5);
  for (auto& [computation, record] : failed.runs) record["status"] = "failed";
  EXPECT_THROW(update_baseline(failed, folder(), "why not", date), std::invalid_argument);
  ResultSet older = make_set(0.5);
  for (auto& [computation, record] : older.runs) record["provenance"]["code_version"] = "older";
  EXPECT_THROW(update_baseline(older, folder(), "why not", date), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder()));
}

TEST_F(BaselineTest, AHistoryThatCannotBeReadLeavesTheRecordsAsTheyWere) {
  update_baseline(make_set(0.5), folder(), "first", date);
  const std::string before = read_file(folder() / "records.jsonl");
  std::filesystem::remove(folder() / "history.jsonl");
  std::filesystem::create_directory(folder() / "history.jsonl");
  EXPECT_THROW(update_baseline(make_set(0.6), folder(), "second", date), std::runtime_error);
  EXPECT_EQ(read_file(folder() / "records.jsonl"), before);
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << "a draft was left: " << entry.path();
  }
}

}  // namespace textonbench::baseline_test
