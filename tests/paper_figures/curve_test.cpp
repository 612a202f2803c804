#include "paper_figures/curve.h"

#include <gmock/gmock.h>

#include <cmath>

#include "paper_figures/figures.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::curve_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class CurveTest : public FiguresTest {
 protected:
  FigureTable& add_curve(const std::vector<std::string>& runs) {
    FigureTable& table = add_figure("sweep", "curve", runs);
    table.options["parameter"] = std::string("mni");
    table.options["metric"] = std::string("rme");
    return table;
  }
  void add(const std::string& label, const std::string& exemplar, double mni, double rme, std::uint64_t seed = 1) {
    results_.append(record_of(plan_run(label, exemplar, seed, {{"mni", mni}, {"route", std::string("auto")}}), rme));
  }
  CurveContents fill() {
    runs_ = select_runs(config_.figures[0], plan_, results_.read().records);
    return fill_curve({config_.figures[0], runs_, "f"});
  }
  std::vector<SelectedRun> runs_;
};

TEST_F(CurveTest, OneLineAGroupWithAPointAValueOfTheParameter) {
  for (const double mni : {30.0, 5.0}) {
    for (int e = 0; e < 6; ++e) {
      add("a", "e" + std::to_string(e), mni, 1 / mni + 0.01 * e, 1);
      add("a", "e" + std::to_string(e), mni, 1 / mni + 0.01 * e + 0.02, 2);
      add("b", "e" + std::to_string(e), mni, 0.5);
    }
  }
  add_curve({"a", "b"});
  const CurveContents curve = fill();
  ASSERT_EQ(curve.lines.size(), 2U);
  EXPECT_EQ(curve.lines[0].title, "a");
  ASSERT_EQ(curve.lines[0].points.size(), 2U);
  const CurvePoint& first = curve.lines[0].points[0];
  EXPECT_EQ(first.x, 5);
  EXPECT_NEAR(first.y.value, 0.2 + 0.035, 1e-12);
  EXPECT_LT(first.y.low, 0.235);
  EXPECT_GT(first.y.high, 0.235);
  EXPECT_EQ(first.count, 12U);
  EXPECT_EQ(curve.lines[1].points[1].y.low, 0.5) << "equal values have a band of no width";
  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  EXPECT_THAT(read_file(figure_file("sweep.svg")), AllOf(HasSubstr("a, mni = 5: 0.2350 ["), HasSubstr("(of 12)")));
}

TEST_F(CurveTest, ADeviationByExemplar) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    add("a", "ring", 10, 0.1 * static_cast<double>(seed), seed);
    add("a", "bark", 10, 0.5, seed);
  }
  FigureTable& table = add_curve({"a"});
  table.options["band"] = std::string("deviation");
  table.options["each"] = std::string("exemplar");
  const CurveContents curve = fill();
  ASSERT_EQ(curve.lines.size(), 2U);
  EXPECT_EQ(curve.lines[0].title, "ring");
  EXPECT_NEAR(curve.lines[0].points[0].y.value, 0.2, 1e-12);
  EXPECT_NEAR(curve.lines[0].points[0].y.high, 0.3, 1e-12);
  EXPECT_NEAR(curve.lines[1].points[0].y.low, 0.5, 1e-12);
}

TEST_F(CurveTest, WhatCannotBeDrawnIsTold) {
  add("a", "ring", 10, 0.5);
  add("a", "ring", 20, 0);
  results_.append(unsuccessful(plan_run("a", "ring", 1, {{"mni", 30.0}, {"route", std::string("auto")}}), "failed",
                               "killed by SIGSEGV"));
  add_curve({"a"}).options["scale"] = std::string("log");
  const CurveContents curve = fill();
  ASSERT_EQ(curve.lines.size(), 1U);
  EXPECT_EQ(curve.lines[0].points.size(), 1U);
  EXPECT_THAT(curve.gaps, ElementsAre(HasSubstr("a on ring at 20: a value that is not positive"),
                                      HasSubstr("a on ring at 30: failed: killed by SIGSEGV")));
  EXPECT_EQ(make_figures(config_, plan_, results_).made(), 1U);
}

TEST_F(CurveTest, RefusesWhatItDoesNotKnow) {
  add("a", "ring", 10, 0.5);
  FigureTable& table = add_curve({"a"});
  const auto refusal = [&] { fill(); };
  table.options["parameter"] = std::string("route");
  EXPECT_THAT(refusal, ThrowsMessage<ConfigError>(HasSubstr("rpn has no number of this name")));
  table.options["parameter"] = std::string("mni");
  table.options["band"] = std::string("wide");
  EXPECT_THAT(refusal, ThrowsMessage<ConfigError>(HasSubstr("expected \"interval\" or \"deviation\"")));
  table.options.erase("band");
  table.options.erase("metric");
  EXPECT_THAT(refusal, ThrowsMessage<ConfigError>(HasSubstr("curve \"sweep\" needs metric")));
}

}  // namespace textonbench::curve_test
