#include "paper_figures/texton_table.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "paper_figures/figures.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::texton_table_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class TextonTableTest : public FiguresTest {
 protected:
  /// A run of a texton with that RME, whose patch distance is (1 + needed / mni) times its floor.
  void add(const std::string& label, const std::string& exemplar, const std::string& impacts, double mni, double rme,
           double needed) {
    const std::map<std::string, ParamValue> params{{"impacts", impacts},
                                                   {"mni", mni},
                                                   {"support", std::int64_t{31}},
                                                   {"shape", std::string("square")},
                                                   {"mask", std::string()}};
    plan_run(label, exemplar, 1, params);
    plan_.runs.back().spec.metrics = {"kernel_kurtosis", "limit_patch_distance", "rme"};
    Record record = record_of(plan_.runs.back(), rme);
    const double distance = 0.01 * (1 + needed / mni);
    record["metrics"]["limit_patch_distance"] = {
        {"value", distance}, {"stderr", 0.05 * distance}, {"unit", "1"}, {"floor", 0.01}};
    record["metrics"]["kernel_kurtosis"] = {{"value", 3.0}, {"stderr", nullptr}, {"unit", "1"}, {"floor", nullptr}};
    results_.append(record);
  }
  void add_bound(const std::string& exemplar, std::int64_t support, double bound) {
    plan_run("bound", exemplar, 1, {{"support", support}, {"shape", std::string("square")}, {"mask", std::string()}});
    plan_.runs.back().spec.metrics = {"rme_bound"};
    Record record = record_of(plan_.runs.back(), 0);
    record["metrics"] = {{"rme_bound", {{"value", bound}, {"stderr", nullptr}, {"unit", "1"}, {"floor", nullptr}}}};
    results_.append(record);
  }
  std::vector<TextonRow> fill() {
    runs_ = select_runs(config_.figures[0], plan_, results_.read().records);
    return fill_texton_table({config_.figures[0], runs_, "f"});
  }
  static const TextonCell& cell(const TextonLine& line, std::string_view name) {
    const std::vector<TextonColumn> columns = texton_columns();
    const auto column = std::ranges::find(columns, name, &TextonColumn::name);
    return line.cells.at(static_cast<std::size_t>(column - columns.begin()));
  }
  std::vector<SelectedRun> runs_;
};

TEST_F(TextonTableTest, JoinsTheBoundOfTheSameExemplarAndSupport) {
  for (int e = 0; e < 5; ++e) {
    const std::string exemplar = "e" + std::to_string(e);
    for (const double mni : {10.0, 100.0, 1000.0}) add("sot", exemplar, "poisson", mni, 0.5 + 0.01 * e, 100);
    for (const double mni : {2.0, 10.0}) add("sot", exemplar, "stratified", mni, 0.5 + 0.01 * e, e < 4 ? 5 : 50);
    add_bound(exemplar, 31, 0.4);
    add_bound(exemplar, 15, 0.7);
  }
  add_figure("textons", "texton_table", {"sot", "bound"});
  const std::vector<TextonRow> rows = fill();
  ASSERT_EQ(rows.size(), 1U) << "runs of a bound have no row, and impacts make none";
  EXPECT_EQ(rows[0].title, "sot");
  ASSERT_EQ(rows[0].exemplars.size(), 5U);
  const TextonLine& third = rows[0].exemplars[2];
  EXPECT_EQ(third.exemplar, "e2");
  EXPECT_EQ(cell(third, "rme_bound").number->value, 0.4);
  EXPECT_NEAR(cell(third, "gap").number->value, 0.12, 1e-12);
  EXPECT_NEAR(cell(third, "gap_squared").number->value, 0.52 * 0.52 - 0.16, 1e-12);
  EXPECT_NEAR(cell(rows[0].mean, "gap").number->value, 0.12, 1e-12);
  EXPECT_LT(cell(rows[0].mean, "gap").number->low, 0.11);
  EXPECT_EQ(cell(third, "kernel_kurtosis").number->value, 3);
  EXPECT_FALSE(cell(third, "kept_variance").number) << "was not measured";

  // 1 + 100 / mni is 2 at 100, which is one of the points.
  EXPECT_NEAR(cell(third, "poisson_patch_impacts").number->value, 100, 1e-9);
  EXPECT_LT(cell(third, "poisson_patch_impacts").number->low, 95);
  EXPECT_GT(cell(third, "poisson_patch_impacts").number->high, 105);
  EXPECT_NEAR(cell(rows[0].mean, "poisson_patch_impacts").number->value, 100, 1e-9);
  // From 3.5 at 2 to 1.5 at 10.
  const double crossing = 2 * std::pow(5, std::log(3.5 / 2) / std::log(3.5 / 1.5));
  EXPECT_NEAR(cell(third, "stratified_patch_impacts").number->value, crossing, 1e-9);
  EXPECT_FALSE(cell(rows[0].exemplars[4], "stratified_patch_impacts").number) << "6 times the floor at most impacts";
  EXPECT_EQ(cell(rows[0].mean, "stratified_patch_impacts").above, 1U);
  EXPECT_NEAR(cell(rows[0].mean, "stratified_patch_impacts").number->value, crossing, 1e-9);

  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  EXPECT_THAT(read_file(figure_file("textons.html")),
              AllOf(HasSubstr("without 1 of 5 above 10"), HasSubstr("mean of 5 exemplars"), HasSubstr("0.4")));
  EXPECT_THAT(read_file(figure_file("textons.csv")), AllOf(HasSubstr("\r\nsot,e2,0.52,"), HasSubstr("\r\nsot,mean,")));
}

TEST_F(TextonTableTest, RunsThatMeasureNoBoundAreRefused) {
  add("sot", "ring", "poisson", 10, 0.5, 5);
  add_figure("textons", "texton_table", {"sot"});
  const auto check = [&] {
    runs_ = select_runs(config_.figures[0], plan_, {});
    check_texton_table({config_.figures[0], runs_, "f"});
  };
  EXPECT_THAT(check, ThrowsMessage<ConfigError>(HasSubstr("rme_bound")));
}

}  // namespace textonbench::texton_table_test
