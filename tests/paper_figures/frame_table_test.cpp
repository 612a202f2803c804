#include "paper_figures/frame_table.h"

#include <gmock/gmock.h>

#include "paper_figures/figures.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::frame_table_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

class FrameTableTest : public FiguresTest {
 protected:
  const PlannedRun& plan_frames(const std::string& exemplar, std::int64_t support) {
    plan_run("frames", exemplar, 1, {{"support", support}});
    PlannedRun& run = plan_.runs.back();
    run.spec.size = {1000, 500};
    run.spec.gpu = {{"path", "fragment"}};
    return run;
  }
  void add(const std::string& exemplar, std::int64_t support, double ms, bool software = false) {
    Record record = record_of(plan_frames(exemplar, support), 0);
    record["timing"] = {{"path", "fragment"},
                        {"frames", 200},
                        {"ms", {{"median", ms}, {"min", 0.8 * ms}, {"p05", 0.9 * ms}, {"p95", 1.2 * ms}}},
                        {"frames_per_second", 1e3 / ms},
                        {"ns_per_pixel", 2 * ms},
                        {"fetches_per_second", 3e9},
                        {"fetch_ceiling_fraction", 0.25}};
    record["provenance"]["gpu"] = {{"renderer", software ? "llvmpipe" : "Abacus 3000"}, {"software", software}};
    results_.append(record);
  }
  void refuse(const std::string& exemplar, std::int64_t support) {
    results_.append(unsuccessful(plan_frames(exemplar, support), "refused", "needs a GPU: llvmpipe draws in software"));
  }
  FigureTable& add_table() {
    FigureTable& table = add_figure("frames", "frame_table", {"frames"});
    table.options["paper_machine"] = "Quadro";
    table.lists["rows"] = {{{"run", "frames"}, {"support", std::int64_t{64}}, {"label", "small"}, {"paper_ms", 5.0}},
                           {{"run", "frames"}, {"support", std::int64_t{256}}, {"label", "large"}}};
    table.lists["ratios"] = {{{"label", "large to small"}, {"of", "large"}, {"over", "small"}, {"paper", 1.08}}};
    return table;
  }
  FigureInput input() {
    runs_ = select_runs(config_.figures[0], plan_, results_.read().records);
    return {config_.figures[0], runs_, "f"};
  }
  std::vector<SelectedRun> runs_;
};

TEST_F(FrameTableTest, ARowIsTheMeanOfItsRuns) {
  add("ring", 64, 4);
  add("cork", 64, 6);
  add("ring", 256, 10);
  add_table();
  const FrameTable table = fill_frame_table(input());
  ASSERT_EQ(table.rows.size(), 2U);
  const FrameRow& small = table.rows[0];
  EXPECT_EQ(small.runs, 2U);
  EXPECT_EQ(small.renderer, "Abacus 3000");
  EXPECT_DOUBLE_EQ(small.numbers->milliseconds, 5);
  EXPECT_DOUBLE_EQ(small.numbers->p95, 6);
  EXPECT_DOUBLE_EQ(small.numbers->frames_per_second, 200);
  EXPECT_DOUBLE_EQ(small.numbers->ns_per_pixel, 10);
  EXPECT_DOUBLE_EQ(*small.paper_ns_per_pixel, 10) << "5 ms for 1000 x 500 pixels";
  EXPECT_FALSE(table.rows[1].paper_milliseconds);
  EXPECT_DOUBLE_EQ(*table.ratios[0].value, 2);
  EXPECT_EQ(*table.ratios[0].paper, 1.08);

  const std::string text = frame_table_text(input());
  EXPECT_THAT(text, AllOf(HasSubstr("Title of frames\nAbacus 3000\npaper: Quadro\n"), HasSubstr("runs"),
                          HasSubstr("small     2  5.000"), HasSubstr("paper fps"),
                          HasSubstr("large to small  2.00   1.08"), Not(HasSubstr("software"))));
  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  EXPECT_THAT(read_file(figure_file("frames.html")), AllOf(HasSubstr("Quadro"), HasSubstr("mean of 2 runs")));
  EXPECT_THAT(read_file(figure_file("frames.csv")), HasSubstr("small,Abacus 3000,false,2,5,"));
  EXPECT_THAT(read_file(figure_file("frames_ratios.csv")), HasSubstr("large to small,2,1.08"));
}

TEST_F(FrameTableTest, SoftwareIsCalledSoEverywhere) {
  add("ring", 64, 4, true);
  add("ring", 256, 4, true);
  add_table();
  EXPECT_THAT(frame_table_text(input()), AllOf(HasSubstr("llvmpipe [software]"), HasSubstr("software fps")));
  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  EXPECT_THAT(read_file(figure_file("frames.html")),
              AllOf(HasSubstr("llvmpipe [software]"), HasSubstr("software fps")));
}

TEST_F(FrameTableTest, RowsOfSeveralRenderersNameTheirs) {
  add("ring", 64, 4, true);
  add("ring", 256, 5);
  add_table();
  EXPECT_FALSE(fill_frame_table(input()).ratios[0].value) << "says nothing of the textons";
  EXPECT_THAT(frame_table_text(input()),
              AllOf(HasSubstr("\nsmall  llvmpipe [software]  4.000"), HasSubstr("250.0 in software"),
                    HasSubstr("\nlarge  Abacus 3000          5.000"), Not(HasSubstr("200.0 in software")),
                    HasSubstr("large to small     –   1.08"), Not(HasSubstr("software fps"))));
  make_figures(config_, plan_, results_);
  EXPECT_THAT(read_file(figure_file("frames.html")),
              AllOf(HasSubstr("250.0 in software"), HasSubstr(">here<"), Not(HasSubstr("software fps"))));
}

TEST_F(FrameTableTest, ARefusedRowSaysWhy) {
  refuse("ring", 64);
  refuse("ring", 256);
  add_table();
  EXPECT_EQ(frame_table_text(input()), "Title of frames\n  refused: needs a GPU: llvmpipe draws in software\n");
  const FrameTable table = fill_frame_table(input());
  EXPECT_FALSE(table.rows[0].numbers);
  EXPECT_FALSE(table.ratios[0].value);
  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  EXPECT_THAT(read_file(figure_file("frames.html")), HasSubstr("needs a GPU"));

  plan_frames("cork", 64);
  ASSERT_EQ(make_figures(config_, plan_, results_).refused(), 1U) << "a record is missing";
  for (const char* file : {"frames.html", "frames.csv", "frames_ratios.csv"}) {
    EXPECT_FALSE(std::filesystem::exists(figure_file(file))) << file;
  }
}

TEST_F(FrameTableTest, BadKeysAreToldWithTheirPlace) {
  add("ring", 64, 4);
  FigureTable& table = add_table();
  const auto check = [&] { check_frame_table(input()); };
  EXPECT_NO_THROW(check());
  table.lists["ratios"][0]["over"] = "smal";
  EXPECT_THAT(check, ThrowsMessage<ConfigError>(HasSubstr("no row has the label \"smal\" (did you mean \"small\"?)")));
  table.lists["ratios"].clear();
  table.lists["rows"][0]["paper_ms"] = 0.0;
  EXPECT_THAT(check, ThrowsMessage<ConfigError>(HasSubstr("paper_ms = 0: expected a finite number above 0")));
  table.lists["rows"][0]["paper_ms"] = std::int64_t{5};
  table.lists["rows"][1]["suport"] = std::int64_t{3};
  EXPECT_THAT(check, ThrowsMessage<ConfigError>(HasSubstr("unknown key \"suport\" (did you mean \"support\"?)")));
  table.lists["rows"][1] = {{"run", "frames"}, {"label", "small"}};
  EXPECT_THAT(check, ThrowsMessage<ConfigError>(HasSubstr("two rows have the label \"small\"")));
  add("ring", 256, 4);
  table.lists["rows"][1]["label"] = "large";
  EXPECT_THAT(check,
              ThrowsMessage<ConfigError>(HasSubstr("row \"large\" matches runs that differ in support: add support")));
  table.lists.clear();
  EXPECT_THAT(check, ThrowsMessage<ConfigError>(HasSubstr("needs rows")));
}

}  // namespace textonbench::frame_table_test
