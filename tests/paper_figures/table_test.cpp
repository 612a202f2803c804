#include "paper_figures/table.h"

#include <gmock/gmock.h>

#include <cmath>

#include "paper_figures/figures.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::table_test {

using testing::HasSubstr;
using testing::Not;

class TableTest : public FiguresTest {
 protected:
  TableContents fill() {
    runs_ = select_runs(config_.figures[0], plan_, results_.read().records);
    return fill_table({config_.figures[0], runs_, "f"});
  }
  std::vector<SelectedRun> runs_;
};

TEST_F(TableTest, AveragesOverSeedsThenOverExemplars) {
  results_.append(record_of(plan_run("rpn", "ring", 1), 0.2, 0.03));
  results_.append(record_of(plan_run("rpn", "ring", 2), 0.4, 0.04));
  results_.append(record_of(plan_run("rpn", "white_noise", 1), 0.7, 0.12));
  add_figure("numbers", "table", {"rpn"}).arrays["metrics"] = {std::string("rme"), std::string("mean_error")};

  const TableContents table = fill();

  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.rows[0].exemplars, 2U);
  const Average& rme = table.rows[0].cells[0];
  // ring: (0.2 + 0.4) / 2 = 0.3 with error sqrt(0.03² + 0.04²) / 2 = 0.025; white_noise: 0.7 with error 0.12.
  EXPECT_DOUBLE_EQ(*rme.value, 0.5);
  EXPECT_DOUBLE_EQ(*rme.error, std::hypot(0.025, 0.12) / 2);
  EXPECT_DOUBLE_EQ(*rme.spread, std::sqrt(0.08));
  EXPECT_DOUBLE_EQ(*rme.floor, 0.125);
  EXPECT_EQ(rme.count, 2U);
  EXPECT_FALSE(table.rows[0].cells[1].error) << "no record has a standard error of mean_error";
}

TEST_F(TableTest, MakesARowForEachMethodAndSetOfOptions) {
  results_.append(record_of(plan_run("rpn", "ring", 1, {{"phase", std::string("added")}}), 0.2));
  results_.append(record_of(plan_run("rpn", "ring", 1, {{"phase", std::string("replaced")}}), 0.6));
  results_.append(record_of(plan_run("other", "ring"), 0.3));
  FigureTable& figure = add_figure("numbers", "table", {"rpn", "other"});
  figure.lists["labels"] = {{{"run", std::string("rpn")}, {"label", std::string("RPN")}}};
  const TableContents table = fill();
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0].group.title, "RPN (phase = added)");
  EXPECT_EQ(table.rows[1].group.title, "RPN (phase = replaced)");
  EXPECT_EQ(table.rows[2].group.title, "other");
  ASSERT_EQ(table.metrics.size(), 2U) << "all metrics that the runs measure, in catalogue order";
  EXPECT_EQ(table.metrics[0]->name, "rme");
}

TEST_F(TableTest, TellsRunsWithoutAResult) {
  results_.append(record_of(plan_run("rpn", "ring"), 0.2));
  results_.append(unsuccessful(plan_run("rpn", "white_noise"), "failed", "timed out after 300 s"));
  add_figure("numbers", "table", {"rpn"});
  const TableContents table = fill();
  EXPECT_EQ(table.rows[0].cells[0].count, 1U);
  EXPECT_DOUBLE_EQ(*table.rows[0].cells[0].value, 0.2);
  ASSERT_EQ(table.rows[0].notes.size(), 1U);
  EXPECT_EQ(table.rows[0].notes[0], "white_noise, seed 1: failed: timed out after 300 s");
  make_figures(config_, plan_, results_);
  EXPECT_THAT(read_file(figure_file("numbers.html")), HasSubstr("timed out after 300 s"));
  EXPECT_THAT(read_file(figure_file("numbers.html")), HasSubstr("1 of 2 exemplars"));
}

TEST_F(TableTest, WritesCsvInFullPrecision) {
  results_.append(record_of(plan_run("rpn", "a, \"b\""), 1.0 / 3));
  add_figure("numbers", "table", {"rpn"}).arrays["metrics"] = {std::string("rme")};
  make_figures(config_, plan_, results_);
  EXPECT_EQ(read_file(figure_file("numbers.csv")),
            "row,detail,exemplars,rme,rme_stderr,rme_spread,rme_floor,rme_exemplars\r\n"
            "rpn,\"rpn, 4 samples\",1,0.3333333333333333,0.01,,0.125,1\r\n");
  EXPECT_THAT(read_file(figure_file("numbers_records.csv")), HasSubstr("rpn,\"a, \"\"b\"\"\",1,id0"));
}

TEST_F(TableTest, LeavesOutNumbersThatAreNotFinite) {
  Record record = record_of(plan_run("rpn", "ring"), 0.2);
  record["metrics"]["rme"]["value"] = nullptr;
  results_.append(record);
  add_figure("numbers", "table", {"rpn"}).arrays["metrics"] = {std::string("rme")};
  EXPECT_FALSE(fill().rows[0].cells[0].value);
  make_figures(config_, plan_, results_);
  EXPECT_THAT(read_file(figure_file("numbers.html")), HasSubstr("–"));
}

}  // namespace textonbench::table_test
