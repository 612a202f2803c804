#include "paper_figures/report_changes.h"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/experiments/synthetic_results.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::report_changes_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ChangesTest : public FiguresTest {
 protected:
  void write(const std::filesystem::path& folder, double rme) const {
    std::filesystem::create_directories(folder);
    std::ofstream out(folder / "records.jsonl");
    const ResultSet set = make_synthetic_set([&](SyntheticRun& run) {
      run.metrics = {{"rme", rme + 1e-4 * static_cast<double>(run.exemplar.back() % 5)}};
    });
    for (const auto& [computation, record] : set.runs) out << record.dump() << "\n";
  }
};

TEST_F(ChangesTest, AnIncreaseOfAnErrorIsWorse) {
  write(folder_ / "baseline", 0.5);
  write(folder_, 0.52);
  EXPECT_THAT(changes_html(results_), AllOf(HasSubstr("rme"), HasSubstr("worse"), HasSubstr("+3.9"),
                                            HasSubstr("1 worse."), Not(HasSubstr("class=\"notice\""))));
}

TEST_F(ChangesTest, WhatCannotBeComparedSaysWhy) {
  EXPECT_EQ(changes_html(results_), "");
  write(folder_ / "baseline", 0.5);
  EXPECT_THAT(changes_html(results_), HasSubstr("class=\"notice\""));
  std::ofstream(folder_ / "records.jsonl") << make_synthetic_record({.exemplar = "elsewhere"}).dump() << "\n";
  EXPECT_THAT(changes_html(results_), AllOf(HasSubstr("class=\"notice\""), HasSubstr("share no run")));
}

}  // namespace textonbench::report_changes_test
