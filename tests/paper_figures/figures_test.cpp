#include "paper_figures/figures.h"

#include <gmock/gmock.h>

#include "experiments/exemplars.h"
#include "tests/experiments/exemplar_home.h"
#include "tests/paper_figures/fixture.h"

namespace textonbench::figures_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string message_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(FiguresTest, RefusesAFigureWhoseRecordsAreMissingAndNamesThem) {
  results_.append(record_of(plan_run("rpn", "ring"), 0.5));
  const std::string missing = plan_run("rpn", "white_noise", 3).id;
  plan_run("other", "ring");
  add_figure("numbers", "table", {"rpn"});
  add_figure("all", "table", {"other"});

  const FigureSummary summary = make_figures(config_, plan_, results_);

  EXPECT_EQ(summary.made(), 0U);
  EXPECT_EQ(summary.refused(), 2U);
  EXPECT_THAT(summary.figures[0].refused,
              AllOf(HasSubstr("1 of its 2 records is missing"), HasSubstr("rpn on white_noise, seed 3"),
                    HasSubstr(missing), HasSubstr("textonbench run configs/lectures2022/page.toml")));
  EXPECT_FALSE(std::filesystem::exists(figure_file("numbers.csv")));
}

TEST_F(FiguresTest, TakesRecordsOfSeveralCommitsAndRemovesWhatWasMadeBefore) {
  results_.append(record_of(plan_run("rpn", "ring"), 0.5));
  const PlannedRun later = plan_run("rpn", "white_noise");
  add_figure("numbers", "table", {"rpn"});
  Record record = record_of(later, 0.25);
  results_.append(record);
  ASSERT_EQ(make_figures(config_, plan_, results_).made(), 1U);
  ASSERT_TRUE(std::filesystem::exists(figure_file("numbers.csv")));

  record["provenance"]["git_commit"] = "2222222";
  results_.append(record);
  EXPECT_EQ(make_figures(config_, plan_, results_).figures[0].refused, "") << "the same code computed both";

  plan_run("rpn", "oriented_lobe");
  EXPECT_THAT(make_figures(config_, plan_, results_).figures[0].refused, HasSubstr("1 of its 3 records is missing"));
  EXPECT_FALSE(std::filesystem::exists(figure_file("numbers.csv")));
}

TEST_F(FiguresTest, TakesTheLatestRecordOfARun) {
  const PlannedRun run = plan_run("rpn", "ring");
  results_.append(record_of(run, 0.5));
  results_.append(record_of(run, 0.75));
  add_figure("numbers", "table", {"rpn"});
  make_figures(config_, plan_, results_);
  EXPECT_THAT(read_file(figure_file("numbers.csv")), AllOf(HasSubstr(",0.75,"), Not(HasSubstr(",0.5,0.01"))));
}

TEST_F(FiguresTest, ExplainsAnUnknownKindAndUnknownKeys) {
  plan_run("rpn", "ring");
  FigureTable& table = add_figure("numbers", "tables", {"rpn"});
  table.places["kind"] = {"page.toml", 9, 8};
  EXPECT_THAT(
      message_of([&] { make_figures(config_, plan_, results_); }),
      AllOf(HasSubstr("page.toml:9:8"), HasSubstr("unknown kind of figure \"tables\" (did you mean \"table\"?)")));
  table.kind = "table";
  table.options["metric"] = std::string("rme");
  EXPECT_THAT(message_of([&] { make_figures(config_, plan_, results_); }),
              AllOf(HasSubstr("page.toml:7:1"), HasSubstr("unknown key \"metric\""), HasSubstr("metrics")));
  table.options.clear();
  table.arrays["metrics"] = {std::string("rmee")};
  EXPECT_THAT(message_of([&] { make_figures(config_, plan_, results_); }), HasSubstr("rme"));
  table.arrays["metrics"] = {std::string("skewness")};
  EXPECT_THAT(message_of([&] { make_figures(config_, plan_, results_); }),
              HasSubstr("no run of figure \"numbers\" measures \"skewness\""));
}

TEST_F(FiguresTest, SaysWhenNoExemplarOfAFigureIsHere) {
  add_figure("numbers", "table", {"rpn"});
  plan_.missing.push_back({"wall1004", "buy it", 1});
  EXPECT_THAT(make_figures(config_, plan_, results_).figures[0].refused, HasSubstr("no runs"));
}

/// Where none of the exemplars that are not part of the project is there, figures are refused, never misunderstood.
TEST_F(FiguresTest, OfEveryDeliveredConfigCanBeUnderstood) {
  const std::filesystem::path home = TEXTONBENCH_SOURCE_DIR;
  const DataVariable none("");
  const ExemplarCatalog exemplars(home);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(home / "configs")) {
    if (entry.path().extension() != ".toml" || entry.path().filename() == "exemplars.toml") continue;
    if (entry.path().parent_path().filename() == "claims") continue;
    for (const Profile profile : {Profile::quick, Profile::full}) {
      const Config config = read_config(entry.path(), profile);
      EXPECT_NO_THROW(EXPECT_EQ(make_figures(config, make_plan(config, exemplars), results_).made(), 0U))
          << entry.path();
    }
  }
}

}  // namespace textonbench::figures_test
