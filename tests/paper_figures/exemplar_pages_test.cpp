#include "paper_figures/exemplar_pages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <list>
#include <random>
#include <string>
#include <vector>

#include "paper_figures/equal_cost.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::exemplar_pages_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ExemplarPagesTest : public FiguresTest {
 protected:
  /// A recorded run of a method.
  void add_run(const std::string& method, const std::string& exemplar, double operations, Extent size = {8, 6}) {
    planned_.push_back({plan_run(method, exemplar)});
    PlannedRun& planned = planned_.back();
    planned.spec.method = method;
    Record record = record_of(planned, 0.25);
    record["metrics"]["operations_per_pixel"] = {{"value", operations}, {"stderr", nullptr}, {"unit", "1"}};
    add_picture(record, "sample", size, 1, 0, 0);
    add_picture(record, "exemplar", size, 0, 1, 0);
    runs_.push_back({{&planned, planned.label, record}, &config_});
  }

  std::list<PlannedRun> planned_;
  std::vector<ReportRun> runs_;
};

TEST_F(ExemplarPagesTest, OfEachMethodTheNearestRunWithinAFactorOfTwo) {
  for (const double operations : {40.0, 90.0, 180.0, 260.0}) add_run("rpn", "ring", operations);
  add_run("sot", "ring", 120);
  add_run("lrp", "ring", 201);
  const std::vector<CostLevel> levels = cost_levels(costed_runs(runs_, "ring"));
  // 100: rpn 90 and sot 120, not lrp 201; 300: rpn 260 and lrp 201; of the other budgets only one method is near.
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[0].budget, 100);
  ASSERT_EQ(levels[0].runs.size(), 2U);
  EXPECT_EQ(levels[0].runs[0].operations, 90);
  EXPECT_EQ(levels[0].runs[1].operations, 120);
  ASSERT_EQ(levels[0].absent.size(), 1U);
  EXPECT_EQ(levels[0].absent[0].method, "lrp");
  EXPECT_EQ(levels[0].absent[0].nearest, 201);
  EXPECT_EQ(levels[1].budget, 300);
}

/// The same by looking at every run for every method and budget.
TEST_F(ExemplarPagesTest, AgreesWithBruteForce) {
  std::mt19937 random(5);
  const std::vector<std::string> methods{"rpn", "adsn", "sot", "lrp"};
  for (int i = 0; i < 40; ++i) {
    add_run(methods[random() % 4], "ring", std::pow(10.0, 1 + static_cast<double>(random() % 1000) / 250));
  }
  const std::vector<CostedRun> runs = costed_runs(runs_, "ring");
  ASSERT_EQ(runs.size(), 40U);
  for (const CostLevel& level : cost_levels(runs)) {
    for (const std::string& method : methods) {
      double least = 1e300;
      for (const CostedRun& run : runs) {
        if (run.entry->run.spec().method == method) {
          least = std::min(least, std::max(run.operations / level.budget, level.budget / run.operations));
        }
      }
      const auto chosen = std::ranges::find_if(
          level.runs, [&](const CostedRun& run) { return run.entry->run.spec().method == method; });
      ASSERT_EQ(chosen != level.runs.end(), least <= 2) << method << " " << level.budget;
      if (chosen != level.runs.end()) {
        EXPECT_NEAR(std::max(chosen->operations / level.budget, level.budget / chosen->operations), least, 1e-9);
      }
    }
  }
}

TEST_F(ExemplarPagesTest, OnlyComparableRunsCount) {
  add_run("rpn", "ring", 100);
  add_run("sot", "ring", 100);
  add_run("adsn", "ring", 100, {4, 4});  // of another size
  add_run("lrp", "ring", 100);
  runs_.back().run.record->at("metrics").erase("rme");
  add_run("gabor", "ring", 100);
  runs_.back().run.record->at("pictures").erase("sample");
  add_run("dsn", "ring", 100);
  runs_.back().run.record->at("status") = "failed";
  add_run("texton_noise", "white_noise", 100);
  EXPECT_EQ(costed_runs(runs_, "ring").size(), 2U);
  EXPECT_TRUE(cost_levels(costed_runs(runs_, "white_noise")).empty());
  EXPECT_TRUE(costed_runs(runs_, "nowhere").empty());
}

TEST_F(ExemplarPagesTest, APageShowsAllMethodsAndOldOnesGo) {
  add_run("rpn", "a<b", 100);
  add_run("sot", "a<b", 110);
  add_run("sot", "ring", 110);
  std::filesystem::create_directories(folder_ / "report");
  write_atomically(folder_ / "report" / "exemplar_gone.html", "old");
  const auto pages = write_exemplar_pages(runs_, results_);
  ASSERT_EQ(pages.size(), 1U);
  EXPECT_EQ(pages.at("a<b"), "exemplar_a-3cb.html");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "report" / "exemplar_gone.html"));
  const std::string page = read_file(folder_ / "report" / "exemplar_a-3cb.html");
  EXPECT_THAT(page, AllOf(HasSubstr("a&lt;b: methods at equal cost"), HasSubstr("About 100 operations a pixel"),
                          HasSubstr("RME 0.250, 110 operations a pixel"), HasSubstr("Runs of 50 to 200 operations"),
                          HasSubstr("data:image/png;base64"), Not(HasSubstr("a<b")), Not(HasSubstr("https://"))));
  // The same records make the same bytes.
  write_exemplar_pages(runs_, results_);
  EXPECT_EQ(read_file(folder_ / "report" / "exemplar_a-3cb.html"), page);
}

}  // namespace textonbench::exemplar_pages_test
