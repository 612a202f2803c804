#include "experiments/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.h"

namespace textonbench::config_test {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class ConfigTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text, const std::string& name = "c.toml") const {
    std::filesystem::path file = folder_.path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  Config read(const std::string& text, Profile profile = Profile::quick) const {
    return read_config(write(text), profile);
  }

  /// The message for a config, from the line number on.
  std::string error_of(const std::string& text) const {
    const std::filesystem::path file = write(text);
    try {
      read_config(file, Profile::quick);
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), StartsWith(file.string() + ":"));
      return std::string(error.what()).substr(file.string().size() + 1);
    }
    ADD_FAILURE() << "no ConfigError for\n" << text;
    return "";
  }

  const TemporaryFolder folder_;
  const std::string head_ = "title = \"T\"\nsource = \"S\"\n";  // two lines
  const std::string runs_ = "[[runs]]\nname = \"a\"\nmethod = \"rpn\"\nexemplars = \"ring\"\n";
};

TEST_F(ConfigTest, ReadsEveryKey) {
  const Config config = read(R"(title = "Title"
source = "Source"
description = "Words"
[defaults]
samples = 8
metrics = ["@all"]
[[runs]]
name = "rpn"
method = ["rpn", "adsn"]
exemplars = ["@default", "ring"]
seeds = [1, 9223372036854775807]
size = [[0, 0], [512, 256]]
periodic = [true, false]
combine = "zip"
timeout_seconds = 12.5
pictures = ["sample"]
params.component = ["periodic", "raw"]
params.order = 2
params.step = [0.5, 1]
exclude = [{exemplar = "ring", component = "raw"}, {seed = 2}]
[[figures]]
name = "panel"
kind = "panel"
title = "Figure"
caption = "Below"
runs = ["rpn"]
scale = 2.5
metrics = ["rme", "skewness"]
columns = [{run = "rpn", picture = "sample", seed = 1}]
)");
  EXPECT_EQ(config.title, "Title");
  EXPECT_EQ(config.source, "Source");
  EXPECT_EQ(config.description, "Words");
  ASSERT_EQ(config.runs.size(), 1U);
  const RunsTable& runs = config.runs[0];
  EXPECT_EQ(runs.label, "rpn");
  EXPECT_EQ(runs.place.line, 7U);
  EXPECT_EQ(runs.combine, Combine::zip);
  EXPECT_THAT(runs.methods, ElementsAre("rpn", "adsn"));
  EXPECT_THAT(runs.exemplars, ElementsAre("@default", "ring"));
  EXPECT_THAT(runs.seeds, ElementsAre(1U, 9223372036854775807U));
  EXPECT_THAT(runs.sizes, ElementsAre(Extent{}, Extent{512, 256}));
  EXPECT_THAT(runs.periodic, ElementsAre(true, false));
  EXPECT_EQ(runs.samples, 8);
  EXPECT_EQ(runs.timeout_seconds, 12.5);
  EXPECT_THAT(runs.metrics, ElementsAre("@all"));
  EXPECT_THAT(runs.pictures, ElementsAre("sample"));
  EXPECT_THAT(runs.params.at("component"), ElementsAre(ParamValue("periodic"), ParamValue("raw")));
  EXPECT_THAT(runs.params.at("order"), ElementsAre(ParamValue(std::int64_t{2})));
  EXPECT_THAT(runs.params.at("step"), ElementsAre(ParamValue(0.5), ParamValue(std::int64_t{1})));
  ASSERT_EQ(runs.exclude.size(), 2U);
  EXPECT_EQ(runs.exclude[0].at("component"), ParamValue("raw"));
  EXPECT_EQ(runs.exclude[1].at("seed"), ParamValue(std::int64_t{2}));
  EXPECT_EQ(runs.places.at("params.component[1]").line, 17U);
  EXPECT_EQ(runs.places.at("params.component[1]").column, 33U);

  ASSERT_EQ(config.figures.size(), 1U);
  const FigureTable& figure = config.figures[0];
  EXPECT_EQ(figure.name, "panel");
  EXPECT_EQ(figure.kind, "panel");
  EXPECT_EQ(figure.title, "Figure");
  EXPECT_EQ(figure.caption, "Below");
  EXPECT_THAT(figure.runs, ElementsAre("rpn"));
  EXPECT_EQ(figure.options.at("scale"), ParamValue(2.5));
  EXPECT_THAT(figure.arrays.at("metrics"), ElementsAre(ParamValue("rme"), ParamValue("skewness")));
  EXPECT_EQ(figure.lists.at("columns")[0].at("seed"), ParamValue(std::int64_t{1}));
  EXPECT_EQ(figure.places.at("columns[0].picture").line, 29U);
}

TEST_F(ConfigTest, StatesItsDefaults) {
  const Config config = read(head_ + runs_);
  const RunsTable& runs = config.runs.at(0);
  EXPECT_THAT(runs.seeds, ElementsAre(1U));
  EXPECT_THAT(runs.sizes, ElementsAre(Extent{}));
  EXPECT_THAT(runs.periodic, ElementsAre(true));
  EXPECT_EQ(runs.combine, Combine::grid);
  EXPECT_EQ(runs.samples, 1);
  EXPECT_EQ(runs.timeout_seconds, 300);
  EXPECT_THAT(runs.metrics, IsEmpty());
  EXPECT_THAT(config.figures, IsEmpty());
}

TEST_F(ConfigTest, LayersOverrideInOrder) {
  const std::string text = head_ + R"(
[defaults]
samples = 1
seeds = 1
timeout_seconds = 10
metrics = "rme"
params.a = 1
params.b = 1
[profile.full]
seeds = 2
timeout_seconds = 20
metrics = "skewness"
params.b = 2
[[runs]]
name = "plain"
method = "rpn"
exemplars = "ring"
[[runs]]
name = "own"
method = "rpn"
exemplars = "ring"
timeout_seconds = 30
metrics = []
params.b = 3
[runs.profile.full]
metrics = ["mean_error"]
)";
  const Config quick = read(text, Profile::quick);
  EXPECT_THAT(quick.runs[0].seeds, ElementsAre(1U));
  EXPECT_EQ(quick.runs[0].timeout_seconds, 10);
  EXPECT_THAT(quick.runs[0].metrics, ElementsAre("rme"));
  EXPECT_EQ(quick.runs[1].timeout_seconds, 30);
  EXPECT_THAT(quick.runs[1].metrics, IsEmpty());

  const Config full = read(text, Profile::full);
  EXPECT_EQ(full.runs[0].samples, 1);
  EXPECT_THAT(full.runs[0].seeds, ElementsAre(2U));
  EXPECT_EQ(full.runs[0].timeout_seconds, 20);
  EXPECT_THAT(full.runs[0].metrics, ElementsAre("skewness"));
  EXPECT_EQ(full.runs[0].params.at("a")[0], ParamValue(std::int64_t{1}));
  EXPECT_EQ(full.runs[0].params.at("b")[0], ParamValue(std::int64_t{2}));
  EXPECT_EQ(full.runs[1].timeout_seconds, 30);
  EXPECT_THAT(full.runs[1].metrics, ElementsAre("mean_error"));
  EXPECT_EQ(full.runs[1].params.at("a")[0], ParamValue(std::int64_t{1}));
  EXPECT_EQ(full.runs[1].params.at("b")[0], ParamValue(std::int64_t{3}));
}

TEST_F(ConfigTest, IsNamedByItsPlaceBelowConfigs) {
  EXPECT_EQ(read_config(write(head_ + runs_, "configs/paper/table_1.toml"), Profile::quick).name, "paper/table_1");
  EXPECT_EQ(read_config(write(head_ + runs_, "elsewhere/mine.toml"), Profile::quick).name, "mine");
}

TEST_F(ConfigTest, AFigureWithoutRunsReadsThemAll) {
  const Config config = read(head_ + runs_ + "[[figures]]\nname = \"f\"\nkind = \"table\"\ntitle = \"t\"\n");
  EXPECT_THAT(config.figures[0].runs, ElementsAre("a"));
}

TEST_F(ConfigTest, NamesAFileThatCannotBeRead) {
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      read_config(file, Profile::quick);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message(folder_.path() / "none.toml"),
            (folder_.path() / "none.toml").string() + ": cannot be read, expected a TOML file");
  EXPECT_THAT(message(folder_.path()), EndsWith(": is a folder, expected a TOML file"));
}

TEST_F(ConfigTest, TellsThePlaceOfASyntaxError) {
  EXPECT_THAT(error_of("title = \"T\"\nsource = \n"), StartsWith("2:10: "));
  EXPECT_THAT(error_of(head_ + "seeds = [1, 2"), StartsWith("3:14: "));
  EXPECT_THAT(error_of(head_ + "title = \"again\"\n"), StartsWith("3:"));
  EXPECT_THAT(error_of("title = \"\xff\"\n"), StartsWith("1:"));
  EXPECT_THAT(error_of(head_ + "[defaults]\nsamples = 1979-05-27\n"), AllOf(StartsWith("4:11: "), HasSubstr("date")));
  EXPECT_THAT(error_of(head_ + "[defaults]\nsamples = nan\n"), AllOf(StartsWith("4:11: "), HasSubstr("finite")));
}

TEST_F(ConfigTest, RefusesUnknownKeysEverywhere) {
  EXPECT_THAT(error_of(head_ + "tilte = 1\n" + runs_),
              AllOf(StartsWith("3:1: unknown key \"tilte\""), HasSubstr("(did you mean \"title\"?)")));
  EXPECT_THAT(error_of(head_ + "[defaults]\nsample = 3\n" + runs_),
              AllOf(StartsWith("4:1: unknown key \"sample\" in [defaults]"), HasSubstr("did you mean \"samples\"")));
  EXPECT_THAT(error_of(head_ + "[defaults]\nname = \"x\"\n" + runs_), StartsWith("4:1: unknown key \"name\""));
  EXPECT_THAT(error_of(head_ + runs_ + "seed = 3\n"),
              AllOf(StartsWith("7:1: unknown key \"seed\" in [[runs]]"), HasSubstr("did you mean \"seeds\"")));
  EXPECT_THAT(error_of(head_ + runs_ + "[runs.profile.quick]\nname = \"x\"\n"), StartsWith("8:1: unknown key"));
}

TEST_F(ConfigTest, ChecksTheProfileThatIsNotAskedFor) {
  EXPECT_THAT(error_of(head_ + "[profile.full]\nsampels = 3\n" + runs_),
              AllOf(StartsWith("4:1: "), HasSubstr("did you mean \"samples\"")));
  EXPECT_THAT(error_of(head_ + "[profile.full]\nsamples = \"many\"\n" + runs_), StartsWith("4:11: "));
}

TEST_F(ConfigTest, KnowsTwoProfiles) {
  EXPECT_THAT(
      error_of(head_ + "[profile.quik]\nsamples = 3\n" + runs_),
      AllOf(StartsWith("3:10: unknown key \"quik\""), HasSubstr("did you mean \"quick\""), HasSubstr("quick, full")));
  EXPECT_THAT(error_of(head_ + runs_ + "[runs.profile.long]\nsamples = 3\n"),
              AllOf(StartsWith("7:15: unknown key \"long\""), HasSubstr("quick, full")));
}

TEST_F(ConfigTest, TellsWhatIsMissing) {
  EXPECT_THAT(error_of(""), AllOf(StartsWith("1:1: "), HasSubstr("lacks the key \"title\"")));
  EXPECT_THAT(error_of("title = \"T\"\nsorce = \"S\"\n"),
              AllOf(StartsWith("2:1: "), HasSubstr("lacks the key \"source\" (is it \"sorce\"?)")));
  EXPECT_THAT(error_of(head_), HasSubstr("lacks the key \"runs\""));
  EXPECT_THAT(error_of(head_ + "[[runs]]\nmethod = \"rpn\"\n"),
              AllOf(StartsWith("3:1: "), HasSubstr("[[runs]] lacks the key \"name\"")));
  EXPECT_THAT(error_of(head_ + "[[runs]]\nname = \"a\"\nmethod = \"rpn\"\n"),
              AllOf(StartsWith("3:1: "), HasSubstr("[[runs]] \"a\" lacks the key \"exemplars\"")));
  EXPECT_THAT(error_of(head_ + runs_ + "[[figures]]\nname = \"f\"\ntitle = \"t\"\n"),
              AllOf(StartsWith("7:1: "), HasSubstr("lacks the key \"kind\"")));
}

TEST_F(ConfigTest, RefusesWrongTypesAndValues) {
  const auto wrong = [&](const std::string& line) { return error_of(head_ + runs_ + line + "\n"); };
  EXPECT_THAT(wrong("samples = \"four\""),
              StartsWith("7:11: samples: expected a whole number from 1 to 1000000, found the string \"four\""));
  EXPECT_THAT(wrong("samples = 0"), HasSubstr("found the whole number 0"));
  EXPECT_THAT(wrong("samples = 2.5"), HasSubstr("found the number 2.5"));
  EXPECT_THAT(wrong("samples = [1, 2]"), HasSubstr("found a list"));
  EXPECT_THAT(wrong("seeds = [1, -2]"), AllOf(StartsWith("7:13: "), HasSubstr("found the whole number -2")));
  EXPECT_THAT(wrong("periodic = \"yes\""), HasSubstr("periodic: expected true or false"));
  EXPECT_THAT(wrong("combine = \"product\""), HasSubstr("expected \"grid\", \"zip\" or \"ablate\", found \"product\""));
  EXPECT_THAT(wrong("timeout_seconds = 0"), HasSubstr("expected a number above 0"));
  EXPECT_THAT(wrong("timeout_seconds = \"long\""), HasSubstr("expected a number above 0"));
  EXPECT_THAT(wrong("size = [512]"), HasSubstr("expected [width, height], found a list of 1"));
  EXPECT_THAT(wrong("size = 512"), StartsWith("7:8: size: expected a list"));
  EXPECT_THAT(wrong("size = [512, 0]"), HasSubstr("found [512, 0]"));
  EXPECT_THAT(wrong("size = [65536, 65536]"), HasSubstr("at most 268435456 pixels"));
  EXPECT_THAT(wrong("size = [[512, 512], 3]"), AllOf(StartsWith("7:21: "), HasSubstr("expected a list")));
  EXPECT_THAT(wrong("size = [512, 1000000]"), HasSubstr("expected a whole number from 0 to 65536"));
  EXPECT_THAT(wrong("metrics = [3]"), HasSubstr("metrics: expected a string"));
  EXPECT_THAT(wrong("params = 3"), HasSubstr("params: expected a table"));
  EXPECT_THAT(wrong("params.a = [[1]]"), HasSubstr("params.a: expected a string, a number, true or false"));
  EXPECT_THAT(wrong("exclude = {seed = 1}"), HasSubstr("exclude: expected a list"));
  EXPECT_THAT(wrong("exclude = [1]"), HasSubstr("exclude: expected a table"));
  EXPECT_THAT(wrong("exclude = [{seed = [1]}]"), HasSubstr("seed: expected a string, a number, true or false"));
  EXPECT_THAT(error_of("title = \"\"\n"), HasSubstr("title: expected a string that is not empty"));
  EXPECT_THAT(error_of(head_ + "[runs]\nname = \"a\"\n"), HasSubstr("runs: expected tables that start with [[runs]]"));
  EXPECT_THAT(error_of(head_ + "defaults = 3\n" + runs_), HasSubstr("[defaults]: expected a table"));
  EXPECT_THAT(error_of(head_ + "[[runs]]\nname = \"../a\"\n"), HasSubstr("expected a name of letters"));
}

TEST_F(ConfigTest, RefusesAnEmptySweep) {
  const auto wrong = [&](const std::string& line) { return error_of(head_ + runs_ + line + "\n"); };
  EXPECT_THAT(wrong("seeds = []"), AllOf(StartsWith("7:9: seeds: "), HasSubstr("empty sweep")));
  EXPECT_THAT(wrong("size = []"), HasSubstr("empty sweep"));
  EXPECT_THAT(wrong("periodic = []"), HasSubstr("empty sweep"));
  EXPECT_THAT(wrong("params.component = []"), HasSubstr("params.component: an empty list makes an empty sweep"));
  EXPECT_THAT(error_of(head_ + "[[runs]]\nname = \"a\"\nmethod = []\n"), HasSubstr("empty sweep"));
  EXPECT_THAT(error_of(head_ + "[[runs]]\nname = \"a\"\nmethod = \"rpn\"\nexemplars = []\n"), HasSubstr("empty sweep"));
  EXPECT_THAT(error_of(head_ + "runs = []\n"), HasSubstr("empty sweep"));
}

TEST_F(ConfigTest, RefusesDuplicates) {
  EXPECT_THAT(error_of(head_ + runs_ + runs_), StartsWith("8:8: a second [[runs]] table is named \"a\""));
  const std::string figure = "[[figures]]\nname = \"f\"\nkind = \"table\"\ntitle = \"t\"\n";
  EXPECT_THAT(error_of(head_ + runs_ + figure + figure), StartsWith("12:8: a second [[figures]] table is named \"f\""));
}

TEST_F(ConfigTest, RefusesFiguresOfUnknownRuns) {
  const auto wrong = [&](const std::string& line) {
    return error_of(head_ + runs_ + "[[runs]]\nname = \"other\"\nmethod = \"rpn\"\nexemplars = \"ring\"\n" +
                    "[[figures]]\nname = \"f\"\nkind = \"panel\"\ntitle = \"t\"\n" + line + "\n");
  };
  EXPECT_THAT(wrong("runs = [\"a\", \"othr\"]"),
              AllOf(StartsWith("15:14: unknown run \"othr\" (did you mean \"other\"?)"), HasSubstr("a, other")));
  EXPECT_THAT(wrong("columns = [{run = \"b2\"}]"), StartsWith("15:19: unknown run \"b2\""));
  EXPECT_THAT(wrong("runs = [\"a\"]\ncolumns = [{run = \"other\"}]"), StartsWith("16:19: unknown run \"other\""));
  EXPECT_THAT(wrong("run = 3"), StartsWith("15:7: unknown run \"3\""));
  EXPECT_THAT(wrong("columns = [{run = \"a\"}, 3]"), HasSubstr("columns: expected a table"));
}

}  // namespace textonbench::config_test
