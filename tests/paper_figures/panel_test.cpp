#include "paper_figures/panel.h"

#include <gmock/gmock.h>

#include "paper_figures/figures.h"
#include "paper_figures/panel_image.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::panel_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class PanelTest : public FiguresTest {
 protected:
  FigureTable& add_panel(std::vector<std::map<std::string, ParamValue>> columns) {
    FigureTable& table = add_figure("panel", "panel", {"rpn"});
    table.lists["columns"] = std::move(columns);
    table.options["cell"] = std::int64_t{64};
    return table;
  }
  static std::map<std::string, ParamValue> column(const char* picture, const char* label) {
    return {{"run", std::string("rpn")}, {"picture", std::string(picture)}, {"label", std::string(label)}};
  }
};

float distance(const Image& image, int x, int y, float red, float green, float blue) {
  return std::abs(image.at(0, x, y) - red) + std::abs(image.at(1, x, y) - green) + std::abs(image.at(2, x, y) - blue);
}

TEST_F(PanelTest, PutsEachPictureInItsCell) {
  Record first = record_of(plan_run("rpn", "ring"), 0.5);
  add_picture(first, "exemplar", {8, 6}, 1, 0, 0);
  add_picture(first, "sample", {80, 64}, 0, 1, 0);
  results_.append(first);
  Record second = record_of(plan_run("rpn", "white_noise"), 0.5);
  add_picture(second, "exemplar", {64, 64}, 0, 0, 1);
  results_.append(second);
  add_panel({column("exemplar", "Input"), column("sample", "RPN")});

  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);

  const std::vector<SelectedRun> runs = select_runs(config_.figures[0], plan_, results_.read().records);
  const PanelGeometry g = panel_geometry(lay_out_panel({config_.figures[0], runs, "f"}), 64);
  const Image panel = read_image(figure_file("panel.png")).image;
  EXPECT_EQ(panel.extent(), g.extent());
  EXPECT_EQ(panel.width(), 2 * 64 + g.gap + g.header + 2 * g.margin);
  const auto middle = [&](int start) { return start + 32; };
  EXPECT_LT(distance(panel, middle(g.left(0)), middle(g.top(0)), 1, 0, 0), 0.01F);
  EXPECT_LT(distance(panel, middle(g.left(1)), middle(g.top(0)), 0, 1, 0), 0.01F);
  EXPECT_LT(distance(panel, middle(g.left(0)), middle(g.top(1)), 0, 0, 1), 0.01F);
  // 8 x 6 pixels are enlarged eightfold: the whole width, and 48 of 64 rows.
  EXPECT_LT(distance(panel, g.left(0), g.top(0) + 8, 1, 0, 0), 0.01F);
  EXPECT_LT(distance(panel, g.left(0), g.top(0) + 7, 1, 1, 1), 0.01F);
  // 80 x 64 pixels show their central 64 columns.
  EXPECT_LT(distance(panel, g.left(1) + 63, g.top(0), 0, 1, 0), 0.01F);
  // The cell without a picture is gray, not blank.
  EXPECT_LT(distance(panel, g.left(1) + 1, g.top(1) + 1, 0.93F, 0.93F, 0.93F), 0.02F);
}

TEST_F(PanelTest, SaysWhyACellIsEmpty) {
  results_.append(unsuccessful(plan_run("rpn", "ring"), "refused", "only periodic domains"));
  results_.append(record_of(plan_run("rpn", "white_noise"), 0.5));
  add_panel({column("sample", "RPN")});
  const std::vector<SelectedRun> runs = select_runs(config_.figures[0], plan_, results_.read().records);
  const PanelLayout layout = lay_out_panel({config_.figures[0], runs, "f"});
  ASSERT_EQ(layout.rows.size(), 2U);
  EXPECT_EQ(layout.rows[0].exemplar, "ring");
  EXPECT_EQ(layout.rows[0].cells[0].absent, "refused: only periodic domains");
  EXPECT_EQ(layout.rows[1].cells[0].absent, "the record holds no such picture");
  EXPECT_EQ(make_figures(config_, plan_, results_).made(), 1U);
}

TEST_F(PanelTest, SelectsARunBySeedAndParameters) {
  plan_run("rpn", "ring", 1, {{"phase", std::string("added")}});
  const std::string wanted = plan_run("rpn", "ring", 2, {{"phase", std::string("added")}}).id;
  plan_run("rpn", "ring", 2, {{"phase", std::string("replaced")}});
  FigureTable& table = add_panel({column("sample", "RPN")});
  const std::vector<SelectedRun> runs = select_runs(table, plan_, {});
  const auto lay_out = [&] { return lay_out_panel({table, runs, "f"}); };
  EXPECT_THAT(lay_out, ThrowsMessage<ConfigError>(
                           AllOf(HasSubstr("matches 3 runs on exemplar ring"), HasSubstr("add phase or seed"))));
  table.lists["columns"][0]["seed"] = std::int64_t{2};
  table.lists["columns"][0]["phase"] = std::string("added");
  EXPECT_EQ(lay_out().rows[0].cells[0].run->planned->id, wanted);
  table.lists["columns"][0]["seed"] = std::int64_t{5};
  EXPECT_THAT(lay_out, ThrowsMessage<ConfigError>(HasSubstr("matches no run")));
}

TEST_F(PanelTest, ChecksItsKeys) {
  plan_run("rpn", "ring");
  FigureTable& table = add_panel({column("sample_2", "RPN")});
  const auto make = [&] { make_figures(config_, plan_, results_); };
  EXPECT_THAT(make, ThrowsMessage<ConfigError>(HasSubstr("keeps no picture \"sample_2\"")));
  table.lists["columns"] = {{{"run", std::string("rpn")}, {"picture", std::string("sample")}}};
  EXPECT_THAT(make, ThrowsMessage<ConfigError>(HasSubstr("has no \"label\"")));
  table.lists["columns"] = {column("sample", "RPN")};
  table.lists["columns"][0]["sed"] = std::int64_t{1};
  EXPECT_THAT(make, ThrowsMessage<ConfigError>(HasSubstr("unknown key \"sed\" (did you mean \"seed\"?)")));
  table.lists["columns"] = {column("sample", "RPN")};
  table.lists["columns"][0]["fit"] = std::string("wide");
  EXPECT_THAT(make, ThrowsMessage<ConfigError>(HasSubstr("expected \"window\" or \"whole\"")));
  table.lists["columns"] = {column("sample", "RPN")};
  table.options["cell"] = std::int64_t{3};
  EXPECT_THAT(make, ThrowsMessage<ConfigError>(HasSubstr("cell = 3")));
  table.lists.clear();
  EXPECT_THAT(make, ThrowsMessage<ConfigError>(HasSubstr("needs columns")));
}

TEST_F(PanelTest, IsDrawnAgainOnlyWhenItsInputsChange) {
  const PlannedRun run = plan_run("rpn", "ring");
  Record record = record_of(run, 0.5);
  add_picture(record, "sample", {64, 64}, 1, 0, 0);
  results_.append(record);
  add_panel({column("sample", "RPN")});
  make_figures(config_, plan_, results_);
  const std::string first = read_file(figure_file("panel.png"));
  write_atomically(figure_file("panel.png"), "as it was");
  make_figures(config_, plan_, results_);
  EXPECT_EQ(read_file(figure_file("panel.png")), "as it was");

  std::filesystem::remove_all(folder_ / "figures");
  make_figures(config_, plan_, results_);
  EXPECT_EQ(read_file(figure_file("panel.png")), first) << "the same records give the same bytes";

  add_picture(record, "sample", {64, 64}, 0, 0, 1);
  results_.append(record);
  make_figures(config_, plan_, results_);
  EXPECT_NE(read_file(figure_file("panel.png")), first);
}

TEST_F(PanelTest, ShowsTexturesByTheirMiddleAndSpectraWhole) {
  EXPECT_EQ(shown_size({300, 100}, 128, PictureFit::window), (Extent{128, 100}));
  EXPECT_EQ(shown_size({256, 64}, 128, PictureFit::whole), (Extent{128, 32}));
  EXPECT_EQ(shown_size({40, 64}, 128, PictureFit::whole), (Extent{40, 64}));
  Image ramp({5, 1}, 1);
  for (int x = 0; x < 5; ++x) ramp.at(0, x, 0) = static_cast<float>(x);
  const Image part = shown_picture(ramp, 3, PictureFit::window);
  EXPECT_EQ(part.width(), 3);
  EXPECT_EQ(part.at(0, 0, 0), 1.0F);
}

}  // namespace textonbench::panel_test
