#include "experiments/claims.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "experiments/ledger.h"
#include "tests/temporary_folder.h"

namespace textonbench::claims_test {

using testing::HasSubstr;

/// A plan of runs "a" and "b" on four exemplars with two seeds each, and a claim that a's number is at most 1.
class ClaimsTest : public testing::Test {
 protected:
  ClaimsTest() {
    claim_.id = "S1";
    claim_.place = {"claims.toml", 3, 6};
    ClaimTest& test = claim_.test.emplace();
    test.config = "c";
    test.config_place = {"claims.toml", 9, 10};
    test.measure = selection("a");
    test.expect.high = 1;
    for (const char* label : {"a", "b"}) {
      for (const char* exemplar : {"ring", "grass", "sand", "wool"}) {
        for (const std::uint64_t seed : {1U, 2U}) {
          RunSpec spec;
          spec.method = "rpn";
          spec.exemplar = exemplar;
          spec.seed = seed;
          spec.metrics = {"rme"};
          spec.params = {{"phase", std::string("added")}};
          Plan& plan = plans_["c"];
          plan.by_label[label].push_back(plan.runs.size());
          plan.runs.push_back({spec, std::string(label) + exemplar + std::to_string(seed), label});
        }
      }
    }
  }

  static ClaimSelection selection(const std::string& run) {
    ClaimSelection result;
    result.place = {"claims.toml", 10, 11};
    result.run = run;
    result.metric = "rme";
    for (const char* key : {"run", "metric", "phse", "exemplar"}) result.places[key] = {"claims.toml", 10, 20};
    return result;
  }

  /// Every run gets number(exemplar index 0 … 3, seed) times `factor` of its label.
  void record_all(double a, double b, double spread) {
    const Plan& plan = plans_["c"];
    for (std::size_t i = 0; i < plan.runs.size(); ++i) {
      const double base = plan.runs[i].label == "a" ? a : b;
      const double value = base * (1 + spread * (static_cast<double>(i / 2 % 4) - 1.5));
      records_.push_back({{"id", plan.runs[i].id},
                          {"status", "ok"},
                          {"metrics", {{"rme", {{"value", value}, {"floor", 2 * value}}}}}});
    }
  }

  ClaimOutcome outcome() const { return evaluate_claims({&claim_, 1}, plans_, records_).front(); }
  std::string check_error() const {
    try {
      check_claims({&claim_, 1}, plans_);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  Claim claim_;
  ClaimPlans plans_;
  std::vector<Record> records_;
};

TEST_F(ClaimsTest, AnIntervalInsideTheRangeIsReproducedOutsideItDeviatesAcrossItIsInconclusive) {
  record_all(0.5, 1, 0.1);
  EXPECT_EQ(outcome().verdict, ClaimVerdict::reproduced);
  EXPECT_EQ(outcome().records.size(), 8U);
  EXPECT_EQ(outcome().command, "textonbench run c");
  EXPECT_NEAR(outcome().measured->value, 0.5, 1e-12);
  EXPECT_LT(outcome().measured->low, 0.5);
  claim_.test->expect = {.high = 0.5};
  EXPECT_EQ(outcome().verdict, ClaimVerdict::inconclusive);
  claim_.test->expect = {.high = 0.3};
  EXPECT_EQ(outcome().verdict, ClaimVerdict::deviates);
  claim_.test->expect = {.low = 0.3, .high = 0.7};
  claim_.caveat = "float32";
  EXPECT_EQ(outcome().verdict, ClaimVerdict::reproduced_with_caveat);
}

TEST_F(ClaimsTest, PairsAreCombinedOnTheSameExemplarAndSeed) {
  record_all(0.5, 1, 0.3);
  claim_.test->against = selection("b");
  claim_.test->combine = CombinePair::ratio;
  EXPECT_NEAR(outcome().measured->value, 0.5, 1e-12);
  EXPECT_NEAR(outcome().measured->high, 0.5, 1e-9);
  claim_.test->against->floor = true;
  EXPECT_NEAR(outcome().measured->value, 0.25, 1e-12);
  claim_.test->combine = CombinePair::difference;
  EXPECT_NEAR(outcome().measured->value, -1.5, 1e-12);
  EXPECT_EQ(outcome().records.size(), 16U);
}

TEST_F(ClaimsTest, ConditionsChooseRuns) {
  record_all(0.5, 1, 0.1);
  claim_.test->measure.conditions = {{"exemplar", std::string("ring")}, {"phase", std::string("added")}};
  EXPECT_EQ(outcome().records.size(), 2U);
  EXPECT_NEAR(outcome().measured->value, 0.5 * 0.85, 1e-12);
}

TEST_F(ClaimsTest, SeedsOfAnExemplarAreTakenTogether) {
  // On each exemplar the two seeds have the numbers 1 and 3: mean 2, deviation √2, least 1.
  record_all(1, 1, 0);
  for (std::size_t i = 0; i < records_.size(); ++i) {
    records_[i]["metrics"]["rme"]["value"] = i % 2 == 0 ? 1.0 : 3.0;
  }
  claim_.test->measure.over_seeds = OverSeeds::deviation;
  EXPECT_NEAR(outcome().measured->value, std::sqrt(2.0), 1e-12);
  claim_.test->measure.over_seeds = OverSeeds::least;
  EXPECT_NEAR(outcome().measured->value, 1, 1e-12);
  claim_.test->against = selection("b");
  claim_.test->against->over_seeds = OverSeeds::mean;
  claim_.test->combine = CombinePair::ratio;
  EXPECT_NEAR(outcome().measured->value, 0.5, 1e-12);
  EXPECT_EQ(outcome().records.size(), 16U);
  claim_.test->against.reset();
  claim_.test->measure.over_seeds = OverSeeds::deviation;
  claim_.test->measure.conditions = {{"seed", std::int64_t{1}}};
  EXPECT_THAT(outcome().reason, HasSubstr("a single seed on grass has no deviation"));
}

TEST_F(ClaimsTest, WhatIsNotThereIsToldAsTheReason) {
  EXPECT_EQ(outcome().verdict, ClaimVerdict::not_run);
  EXPECT_EQ(outcome().reason, "no record yet of 8 of the 8 runs \"a\": textonbench run c");
  record_all(0.5, 1, 0.1);
  records_[3]["status"] = "failed";
  EXPECT_THAT(outcome().reason, HasSubstr("1 of the 8 runs \"a\" failed or were refused"));
  records_[3]["status"] = "ok";
  records_[3]["metrics"]["rme"]["value"] = nullptr;
  EXPECT_THAT(outcome().reason, HasSubstr("no finite rme"));
  records_[3]["metrics"] = Record::object();
  EXPECT_THAT(outcome().reason, HasSubstr("has no rme"));
  claim_.needs = {"gpu"};
  EXPECT_EQ(outcome().reason, "needs a GPU");
  claim_.needs = {"gpu", "method:unheard_of"};
  EXPECT_EQ(outcome().reason, "method not yet built: unheard_of");
  claim_.needs = {"metric:unheard_of", "method:rpn"};
  EXPECT_EQ(outcome().reason, "metric not yet built: unheard_of");
  claim_.needs = {"metric:rme", "method:rpn"};
  claim_.test.reset();
  EXPECT_THAT(outcome().reason, HasSubstr("its test is not written yet"));
}

TEST_F(ClaimsTest, MissingExemplarsAreTold) {
  record_all(0.5, 1, 0.1);
  plans_["c"].missing = {{"wall1004", "from the archive", 2}};
  EXPECT_EQ(outcome().verdict, ClaimVerdict::reproduced);
  EXPECT_EQ(outcome().reason, "without wall1004: not here");
  plans_["c"].by_label["a"].clear();
  EXPECT_THAT(outcome().reason, HasSubstr("exemplar not here: wall1004"));
  EXPECT_EQ(outcome().verdict, ClaimVerdict::not_run);
}

TEST_F(ClaimsTest, ARatioNeedsPositiveNumbers) {
  record_all(-0.5, 1, 0.1);
  claim_.test->against = selection("b");
  claim_.test->combine = CombinePair::ratio;
  EXPECT_EQ(outcome().verdict, ClaimVerdict::not_run);
  EXPECT_THAT(outcome().reason, HasSubstr("expected positive numbers"));
}

TEST_F(ClaimsTest, UnknownConfigsRunsMetricsAndSelectorsAreErrors) {
  EXPECT_EQ(check_error(), "");
  claim_.test->measure.run = "aa";
  EXPECT_EQ(check_error(),
            "claims.toml:10:20: no [[runs]] table of the config is named \"aa\" (did you mean \"a\"?); it has a, b");
  claim_.test->measure = selection("a");
  claim_.test->measure.metric = "ot_distance";
  EXPECT_THAT(check_error(), HasSubstr("do not measure \"ot_distance\""));
  claim_.test->measure = selection("a");
  claim_.test->measure.conditions = {{"phse", std::string("added")}};
  EXPECT_THAT(check_error(), HasSubstr("unknown selector \"phse\""));
  claim_.test->measure.conditions = {{"exemplar", std::string("moss")}};
  EXPECT_THAT(check_error(), HasSubstr("no run of \"a\" meets these conditions"));
  claim_.test->measure = selection("a");
  claim_.test->against = selection("z");
  EXPECT_THAT(check_error(), HasSubstr("\"z\""));
  claim_.test->config = "other";
  EXPECT_EQ(check_error(), "claims.toml:9:10: no config is named \"other\" (textonbench list configs)");
}

TEST(Verdicts, HaveNamesThatReadBack) {
  for (const ClaimVerdict verdict : all_verdicts) EXPECT_EQ(verdict_of(verdict_name(verdict)), verdict);
  EXPECT_THROW(verdict_of("deviate"), std::invalid_argument);
}

TEST(Verdicts, AreWrittenReadAndCompared) {
  const TemporaryFolder folder;
  const std::filesystem::path file = verdicts_file(folder.path());
  EXPECT_TRUE(read_verdicts(file).empty());
  const Verdicts recorded{
      {"A", ClaimVerdict::reproduced}, {"B", ClaimVerdict::deviates}, {"C", ClaimVerdict::inconclusive}};
  write_verdicts(file, recorded);
  EXPECT_EQ(read_verdicts(file), recorded);

  std::vector<Claim> claims(4);
  std::vector<ClaimOutcome> outcomes;
  for (const auto& [id, verdict] :
       {std::pair{"A", ClaimVerdict::inconclusive}, std::pair{"B", ClaimVerdict::reproduced},
        std::pair{"C", ClaimVerdict::not_run}, std::pair{"D", ClaimVerdict::deviates}}) {
    Claim& claim = claims[outcomes.size()];
    claim.id = id;
    ClaimOutcome& outcome = outcomes.emplace_back();
    outcome.claim = &claim;
    outcome.verdict = verdict;
  }
  const std::vector<VerdictChange> changes = changes_since(recorded, outcomes);
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_TRUE(changes[0].worse());
  EXPECT_FALSE(changes[1].worse());
  EXPECT_FALSE(changes[2].worse());
  EXPECT_EQ(verdicts_of(outcomes).at("D"), ClaimVerdict::deviates);

  std::ofstream(file) << "{\"claims\": {\"A\": \"fine\"}}";
  EXPECT_THROW(read_verdicts(file), std::invalid_argument);
  std::ofstream(file) << "{";
  EXPECT_THROW(read_verdicts(file), std::invalid_argument);
}

}  // namespace textonbench::claims_test
