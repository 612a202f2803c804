#include "paper_figures/chart.h"

#include <gmock/gmock.h>

#include <regex>

#include "paper_figures/chart_script.h"
#include "paper_figures/figures.h"
#include "paper_figures/gnuplot.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::chart_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

class ChartTest : public FiguresTest {
 protected:
  FigureTable& add_chart() {
    FigureTable& table = add_figure("errors", "chart", {"rpn", "other"});
    table.options["metric"] = std::string("rme");
    return table;
  }
  ChartContents fill() {
    runs_ = select_runs(config_.figures[0], plan_, results_.read().records);
    return fill_chart({config_.figures[0], runs_, "f"});
  }
  std::vector<SelectedRun> runs_;
};

TEST_F(ChartTest, IsTheSameBytesWhenMadeAgain) {
  results_.append(record_of(plan_run("rpn", "ring"), 0.2));
  results_.append(record_of(plan_run("other", "ring"), 0.4));
  add_chart();
  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  std::vector<std::string> first;
  for (const char* file : {"errors.svg", "errors.pdf", "errors.gp"}) first.push_back(read_file(figure_file(file)));
  std::filesystem::remove_all(folder_ / "figures");
  // A PDF carries its time of creation in seconds unless that is blanked.
  ::usleep(1'100'000);
  make_figures(config_, plan_, results_);
  EXPECT_EQ(read_file(figure_file("errors.svg")), first[0]);
  EXPECT_EQ(read_file(figure_file("errors.pdf")), first[1]);
  EXPECT_EQ(read_file(figure_file("errors.gp")), first[2]);
  EXPECT_THAT(first[0],
              AllOf(HasSubstr("<title>rpn on ring: 0.200 ± 0.010, floor 0.1250</title>"),
                    HasSubstr("data-record=\"id0"), Not(HasSubstr("gnuplot_svg")), Not(HasSubstr("GNUPLOT"))));
  for (const std::string& file : first) EXPECT_THAT(file, Not(HasSubstr(folder_.string())));
}

TEST_F(ChartTest, EscapesHostileNames) {
  const std::string hostile = "<b>\"it's\" & `id` $x {/Bold y}\n</b>";
  results_.append(record_of(plan_run("rpn", hostile), 0.2));
  plan_run("other", hostile);
  results_.append(unsuccessful(plan_.runs.back(), "failed", "'; system('touch owned') #"));
  add_chart();
  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  const std::string svg = read_file(figure_file("errors.svg"));
  EXPECT_THAT(svg, HasSubstr("&lt;b&gt;&quot;it&#39;s&quot; &amp; `id` $x {/Bold y} &lt;/b&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
  EXPECT_FALSE(std::filesystem::exists(figure_file("owned")));
}

TEST_F(ChartTest, NamesGapsInsteadOfLeavingThem) {
  results_.append(record_of(plan_run("rpn", "ring"), 0.2));
  results_.append(record_of(plan_run("rpn", "white_noise"), 0.0));
  results_.append(unsuccessful(plan_run("other", "ring"), "refused", "no reason at all"));
  add_chart().options["scale"] = std::string("log");
  const ChartContents chart = fill();
  ASSERT_EQ(chart.points.size(), 1U);
  ASSERT_EQ(chart.gaps.size(), 2U) << "what was never planned is no gap";
  EXPECT_THAT(chart.gaps[0].reason, HasSubstr("cannot be drawn on a logarithmic axis"));
  EXPECT_EQ(chart.gaps[1].reason, "refused: no reason at all");
  EXPECT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  EXPECT_THAT(read_file(figure_file("errors.svg")), HasSubstr("✕ refused"));
}

TEST_F(ChartTest, AveragesSeedsAndDrawsNegativeValues) {
  results_.append(record_of(plan_run("rpn", "ring", 1), -0.2, 0.03));
  results_.append(record_of(plan_run("rpn", "ring", 2), -0.4, 0.04));
  add_chart().runs = {"rpn"};
  const ChartContents chart = fill();
  ASSERT_EQ(chart.points.size(), 1U);
  EXPECT_DOUBLE_EQ(*chart.points[0].number.value, -0.3);
  EXPECT_DOUBLE_EQ(*chart.points[0].number.error, 0.025);
  EXPECT_THAT(chart.points[0].hover, HasSubstr("mean of 2 seeds"));
  EXPECT_EQ(make_figures(config_, plan_, results_).made(), 1U);
}

TEST_F(ChartTest, ChecksItsKeys) {
  results_.append(record_of(plan_run("rpn", "ring"), 0.2));
  FigureTable& table = add_chart();
  const auto make = [&] { make_figures(config_, plan_, results_); };
  table.options["scale"] = std::string("cubic");
  EXPECT_THAT(make, ThrowsMessage<ConfigError>(HasSubstr("expected \"linear\" or \"log\"")));
  table.options.clear();
  EXPECT_THAT(make, ThrowsMessage<ConfigError>(HasSubstr("needs metric")));
}

TEST_F(ChartTest, NamesThePackageWhenGnuplotIsNotInstalled) {
  results_.append(record_of(plan_run("rpn", "ring"), 0.2));
  add_chart();
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder_.c_str(), 1);
  EXPECT_THAT([&] { make_figures(config_, plan_, results_); },
              ThrowsMessage<std::runtime_error>(HasSubstr("apt-get install gnuplot-nox")));
  ::setenv("PATH", path.c_str(), 1);
}

TEST(Gnuplot, BlanksTheDateOfAPdfWithoutMovingAnything) {
  const std::string pdf = "<< /Producer (cairo)\n   /CreationDate (D:20261122025550Z)\n>>";
  const std::string undated = undated_pdf(pdf);
  EXPECT_EQ(undated.size(), pdf.size());
  EXPECT_THAT(undated, HasSubstr("(D:20000101000000Z)"));
}

TEST(Gnuplot, RefusesAnSvgThatLacksPoints) {
  EXPECT_THROW(annotated_svg("<svg></svg>", {{"id", "text"}}), std::runtime_error);
}

}  // namespace textonbench::chart_test
