#include "experiments/claims_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "experiments/ledger.h"
#include "tests/temporary_folder.h"

namespace textonbench::claims_file_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class ClaimsFileTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text, const std::string& name = "a.toml") const {
    std::filesystem::path file = folder_.path() / name;
    std::ofstream(file) << text;
    return file;
  }
  std::string error_of_files(const std::vector<std::filesystem::path>& files) const {
    try {
      read_claims(files);
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), StartsWith(files.back().string() + ":"));
      return std::string(error.what()).substr(files.back().string().size() + 1);
    }
    ADD_FAILURE() << "no ConfigError";
    return "";
  }
  std::string error_of(const std::string& more) const { return error_of_files({write(head_ + more)}); }

  const TemporaryFolder folder_;
  const std::string claim_ =
      "[[claims]]\nid = \"S1\"\nwhere = \"p. 1\"\nstatement = \"It holds\"\nkind = \"identity\"\n"
      "paper_value = \"0\"\nhow = \"by measuring\"\n";
  const std::string head_ = "paper = \"P\"\n" + claim_;  // eight lines
  const std::string test_ = "config = \"c\"\nmeasure = {run = \"a\", metric = \"rme\"}\n";
};

TEST_F(ClaimsFileTest, ReadsEveryKey) {
  const std::vector<std::filesystem::path> files{
      write(head_ + "caveat = \"C\"\nnote = \"N\"\nneeds = [\"method:sot\", \"gpu\"]\nconfig = \"c\"\n"
                    "measure = {run = \"a\", metric = \"rme\", exemplar = \"ring\"}\n"
                    "against = {run = \"b\", metric = \"rme\", part = \"floor\"}\ncombine = \"ratio\"\n"
                    "expect = {within = [0.9, 1]}\n")};
  const std::vector<Claim> claims = read_claims(files);
  ASSERT_EQ(claims.size(), 1U);
  const Claim& claim = claims.front();
  EXPECT_EQ(claim.paper, "P");
  EXPECT_EQ(claim.id, "S1");
  EXPECT_EQ(claim.caveat, "C");
  EXPECT_THAT(claim.needs, testing::ElementsAre("method:sot", "gpu"));
  ASSERT_TRUE(claim.test && claim.test->against);
  EXPECT_EQ(claim.test->measure.conditions.at("exemplar"), ParamValue(std::string("ring")));
  EXPECT_FALSE(claim.test->measure.floor);
  EXPECT_TRUE(claim.test->against->floor);
  EXPECT_EQ(claim.test->combine, CombinePair::ratio);
  EXPECT_EQ(claim.test->expect.low, 0.9);
  EXPECT_EQ(claim.test->expect.high, 1);
}

TEST_F(ClaimsFileTest, SeedsAreTakenTogetherOnBothSidesOrNeither) {
  const std::string measure = "config = \"c\"\nmeasure = {run = \"a\", metric = \"rme\", over_seeds = \"least\"}\n";
  const std::string against = "combine = \"ratio\"\nagainst = {run = \"b\", metric = \"rme\"";
  const std::string expect = "expect = {above = 1}\n";
  const std::vector<std::filesystem::path> files{
      write(head_ + measure + against + ", over_seeds = \"mean\"}\n" + expect)};
  const std::vector<Claim> claims = read_claims(files);
  EXPECT_EQ(claims.front().test->measure.over_seeds, OverSeeds::least);
  EXPECT_EQ(claims.front().test->against->over_seeds, OverSeeds::mean);
  EXPECT_TRUE(claims.front().test->measure.conditions.empty());
  EXPECT_THAT(error_of(measure + against + "}\n" + expect), HasSubstr("over_seeds in both"));
  EXPECT_THAT(error_of("config = \"c\"\nmeasure = {run = \"a\", metric = \"rme\", over_seeds = \"most\"}\n" + expect),
              HasSubstr("expected one of mean, deviation, least; found \"most\""));
}

TEST_F(ClaimsFileTest, BadInputIsToldWithItsPlace) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"needs = [\"gpu\"]\ncaveats = \"x\"\n",
       "10:1: unknown key \"caveats\" in [[claims]] (did you mean \"caveat\"?)"},
      {"", "neither a test (config, measure, expect) nor needs"},
      {"needs = [\"methods:sot\"]\n", "methods:sot"},
      {"needs = [\"method:\"]\n", "method:"},
      {test_, "lacks the key \"expect\""},
      {"measure = {run = \"a\", metric = \"rme\"}\nneeds = [\"gpu\"]\n", "a test also has the key \"config\""},
      {"config = \"c\"\nmeasure = {run = \"a\", metric = \"rmee\"}\nexpect = {below = 1}\n", "did you mean \"rme\"?"},
      {test_ + "expect = {within = [2, 1]}\n", "no number lies in [2, 1]"},
      {test_ + "expect = {within = [1]}\n", "a list of 1"},
      {test_ + "expect = {below = nan}\n", "11:"},
      {test_ + "expect = {below = 1, above = 0}\n", "exactly one of below, above and within"},
      {test_ + "expect = {}\n", "exactly one of below, above and within"},
      {test_ + "expect = {under = 1}\n", "unknown key \"under\""},
      {test_ + "expect = {below = \"1\"}\n", "below: expected a number"},
      {test_ + "combine = \"ratio\"\nexpect = {below = 1}\n", "nothing to combine with"},
      {test_ + "against = {run = \"b\", metric = \"rme\"}\ncombine = \"sum\"\nexpect = {below = 1}\n", "sum"},
  };
  for (const auto& [more, expected] : cases) {
    EXPECT_THAT(error_of(more), HasSubstr(expected)) << more;
  }
}

TEST_F(ClaimsFileTest, EveryClaimHasAnIdOfItsOwn) {
  EXPECT_THAT(error_of_files({write("paper = \"P\"\n[[claims]]\nwhere = \"w\"\n")}), HasSubstr("lacks the key \"id\""));
  const std::filesystem::path first = write(head_ + "needs = [\"gpu\"]\n");
  const std::filesystem::path second = write("paper = \"Q\"\n" + claim_ + "needs = [\"gpu\"]\n", "b.toml");
  EXPECT_THAT(error_of_files({first, second}),
              AllOf(HasSubstr("a second claim has the id \"S1\""), HasSubstr(first.string() + ":3")));
}

TEST(ClaimsOfThePapers, AreAllThereAndNameWhatExists) {
  const ExemplarCatalog exemplars(TEXTONBENCH_SOURCE_DIR);
  const Ledger ledger = read_ledger(TEXTONBENCH_SOURCE_DIR, exemplars, Profile::quick);
  std::map<char, int> printed;
  for (const Claim& claim : ledger.claims) {
    if (claim.id.size() == 3 && claim.id.front() != 'X') ++printed[claim.id.front()];
  }
  EXPECT_EQ(printed, (std::map<char, int>{{'E', 30}, {'L', 41}, {'S', 41}, {'T', 51}}));
  EXPECT_TRUE(ledger.plans.contains("lectures2022/claims"));
  EXPECT_NO_THROW(read_ledger(TEXTONBENCH_SOURCE_DIR, exemplars, Profile::full));
}

}  // namespace textonbench::claims_file_test
