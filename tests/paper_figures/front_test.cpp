#include "paper_figures/front.h"

#include <gmock/gmock.h>

#include "paper_figures/figures.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::front_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

class FrontTest : public FiguresTest {
 protected:
  FigureTable& add_front() {
    FigureTable& table = add_figure("tradeoff", "front", {"a", "b", "c"});
    table.options["cost"] = std::string("mean_error");
    table.options["quality"] = std::string("rme");
    return table;
  }
  void add(const std::string& label, const std::string& exemplar, double cost, double quality, std::uint64_t seed = 1) {
    Record record = record_of(plan_run(label, exemplar, seed), quality);
    record["metrics"]["mean_error"]["value"] = cost;
    results_.append(record);
  }
  FrontContents fill() {
    runs_ = select_runs(config_.figures[0], plan_, results_.read().records);
    return fill_front({config_.figures[0], runs_, "f"});
  }
  std::vector<SelectedRun> runs_;
};

TEST_F(FrontTest, MeansAndTheFrontAreRight) {
  for (int e = 0; e < 8; ++e) {
    const std::string exemplar = "e" + std::to_string(e);
    add("a", exemplar, 10 + e, 0.5);             // cheap and bad
    add("b", exemplar, 20 + e, 0.3, 1);          // dearer and better …
    add("b", exemplar, 22 + e, 0.2, 2);          // … mean over seeds 0.25
    add("c", exemplar, 30 + e, 0.4 + 0.01 * e);  // beaten by b
  }
  add_front();
  const FrontContents front = fill();
  ASSERT_EQ(front.means.size(), 3U);
  EXPECT_EQ(front.points.size(), 24U);
  EXPECT_NEAR(front.means[0].cost.value, 13.5, 1e-12);
  EXPECT_NEAR(front.means[1].cost.value, 24.5, 1e-12);
  EXPECT_NEAR(front.means[1].quality.value, 0.25, 1e-12);
  EXPECT_NEAR(front.means[2].quality.value, 0.435, 1e-12);
  EXPECT_LT(front.means[2].quality.low, 0.435);
  EXPECT_GT(front.means[2].quality.high, 0.435);
  std::vector<bool> on_front;
  for (const FrontMean& mean : front.means) on_front.push_back(mean.on_front);
  EXPECT_THAT(on_front, ElementsAre(true, true, false));
  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  EXPECT_THAT(read_file(figure_file("tradeoff.svg")),
              AllOf(HasSubstr("c on e3: 0.4300 at 33.00"), HasSubstr("mean of 8 exemplars")));
}

TEST_F(FrontTest, OneExemplarHasNoInterval) {
  add("a", "ring", 10, 0.5);
  add("b", "ring", 10, 0.5);
  add("c", "ring", 11, 0.5);
  add_front();
  const FrontContents front = fill();
  // Equals do not beat each other.
  EXPECT_TRUE(front.means[0].on_front);
  EXPECT_TRUE(front.means[1].on_front);
  EXPECT_FALSE(front.means[2].on_front);
  EXPECT_EQ(make_figures(config_, plan_, results_).made(), 1U);
}

TEST_F(FrontTest, WhatCannotBeDrawnIsTold) {
  add("a", "ring", 10, 0.5);
  add("b", "ring", 0, 0.5);
  results_.append(unsuccessful(plan_run("c", "ring"), "failed", "killed by SIGSEGV"));
  add_front();
  const FrontContents front = fill();
  EXPECT_EQ(front.means.size(), 1U);
  EXPECT_THAT(front.gaps, ElementsAre(HasSubstr("logarithmic axis"), HasSubstr("SIGSEGV")));
  EXPECT_EQ(make_figures(config_, plan_, results_).made(), 1U);
}

TEST_F(FrontTest, BadKeysAreToldWithTheirPlace) {
  add("a", "ring", 10, 0.5);
  add_front().options.erase("cost");
  EXPECT_THAT([&] { fill(); }, ThrowsMessage<ConfigError>(AllOf(HasSubstr("page.toml:7:1"), HasSubstr("cost"))));
  config_.figures[0].options["cost"] = std::string("mean_eror");
  EXPECT_THAT([&] { fill(); }, ThrowsMessage<ConfigError>(HasSubstr("mean_error")));
  config_.figures[0].options["cost"] = std::string("mean_error");
  config_.figures[0].options["scale"] = std::string("cubic");
  EXPECT_THAT([&] { fill(); }, ThrowsMessage<ConfigError>(HasSubstr("\"linear\" or \"log\"")));
}

}  // namespace textonbench::front_test
