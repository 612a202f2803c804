#include "experiments/metrics/texton_quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/metrics/model_error.h"
#include "methods/method.h"
#include "tests/texture.h"

namespace textonbench::texton_quality_test {

class TextonQuality : public testing::Test {
 protected:
  std::unique_ptr<Model> fit(std::string_view method, const std::map<std::string, ParamValue>& given) const {
    const MethodEntry& entry = find_method(method);
    return entry.analyze({exemplar_}, Params(entry.params, given), Seed{3});
  }

  const Exemplar exemplar_ = test_exemplar({26, 22}, 3);
  const Target target_ = make_target(exemplar_);
  const Domain domain_{.size = {26, 22}, .periodic = true};
};

TEST_F(TextonQuality, OfTheWholeExemplarNothingIsLost) {
  const auto model = fit("luminance_texton", {});
  EXPECT_NEAR(*kept_variance(*model, target_, domain_), 1, 1e-5);
  EXPECT_NEAR(*rme_corrected(*model, target_, domain_), 0, 1e-3);
}

TEST_F(TextonQuality, NoTextonOfASupportIsBelowItsBound) {
  const std::map<std::string, ParamValue> support{{"support", std::int64_t{7}}};
  const auto optimal = fit("optimal_texton", support);
  const double bound = *rme_bound(*optimal, target_, domain_);
  EXPECT_GT(bound, 0.05);
  for (const char* method : {"luminance_texton", "sot", "optimal_texton"}) {
    const auto model = fit(method, support);
    const double error = relative_model_error(model->gaussian()->spectrum({26, 22}), target_.gaussian.spectrum);
    EXPECT_GT(error, bound) << method;
    EXPECT_GE(*rme_corrected(*model, target_, domain_), error - 1e-6) << method << ": correcting colors costs";
    EXPECT_LT(*kept_variance(*model, target_, domain_), 1) << method;
  }
}

TEST_F(TextonQuality, ImpactsNeededFollowFromTheKurtosisOfTheKernel) {
  const auto model = fit("sot", {{"support", std::int64_t{17}}});
  const double kurtosis = *kernel_kurtosis(*model, target_, domain_);
  EXPECT_GT(kurtosis, 1);
  EXPECT_NEAR(*poisson_impacts(*model, target_, domain_), kurtosis / 0.1, 1e-6 * kurtosis);
  EXPECT_LT(*stratified_impacts(*model, target_, domain_), *poisson_impacts(*model, target_, domain_));
}

TEST_F(TextonQuality, KurtosisIsPredictedForTheImpactsThatTheModelHas) {
  const auto with = [&](const char* impacts, double mni) {
    return fit("sot", {{"support", std::int64_t{9}}, {"impacts", std::string(impacts)}, {"mni", mni}});
  };
  EXPECT_EQ(*predicted_kurtosis(*with("gaussian", 5), target_, domain_), 0);
  EXPECT_NEAR(*predicted_kurtosis(*with("poisson", 5), target_, domain_),
              2 * *predicted_kurtosis(*with("poisson", 10), target_, domain_), 1e-6);
  EXPECT_LE(*predicted_kurtosis(*with("poisson", 1), target_, domain_),
            *kernel_kurtosis(*with("poisson", 1), target_, domain_));
  EXPECT_FALSE(local_kurtosis_least(*with("poisson", 5), target_, domain_));

  const auto stratified = with("stratified", 5);
  const double predicted = *predicted_kurtosis(*stratified, target_, domain_);
  EXPECT_LT(*local_kurtosis_least(*stratified, target_, domain_), predicted);
  EXPECT_GT(*local_kurtosis_greatest(*stratified, target_, domain_), predicted);
  // On 40 samples of 572 pixels: within five standard errors, sqrt(24 / n) for n effective samples of a correlation
  // area of at most 81 pixels.
  std::vector<Image> samples;
  for (std::uint64_t seed = 0; seed < 40; ++seed) samples.push_back(stratified->synthesize(domain_, Seed{seed}));
  const auto statistic = find_metric("excess_kurtosis").of_samples(target_, domain_, Seed{1});
  EXPECT_NEAR(measure_samples(*statistic, samples, domain_).value, predicted, 5 * std::sqrt(24.0 / (40 * 572 / 81)));
}

TEST_F(TextonQuality, PatchesOfTheGaussianLimitScoreTheFloorWhateverTheTexton) {
  const MetricEntry& metric = find_metric("limit_patch_distance");
  const auto of = [&](const Domain& domain, const char* impacts, double mni) {
    const auto model = fit("sot", {{"support", std::int64_t{5}}, {"impacts", std::string(impacts)}, {"mni", mni}});
    std::vector<Image> samples;
    for (std::uint64_t seed = 0; seed < 8; ++seed) samples.push_back(model->synthesize(domain, Seed{seed}));
    return measure_samples(*metric.of_limit(*model, domain, Seed{1}), samples, domain).value;
  };
  for (const Domain& domain : {Domain{.size = {128, 128}, .periodic = true}, Domain{.size = {200, 160}}}) {
    const double limit = of(domain, "gaussian", 1);
    EXPECT_LT(limit, 0.02);
    EXPECT_NEAR(of(domain, "poisson", 3000), limit, 0.25 * limit);
    EXPECT_GT(of(domain, "poisson", 1), 2 * limit);
  }
  EXPECT_EQ(metric.of_limit(*fit("adsn", {}), domain_, Seed{1}), nullptr);
}

TEST_F(TextonQuality, PatchesOfSplinesTendToTheirOwnGaussianLimit) {
  const Domain domain{.size = {160, 160}};
  const MetricEntry& metric = find_metric("limit_patch_distance");
  for (const int order : {0, 1, 3}) {
    const auto of = [&](double mni) {
      const auto model = fit("texton_noise", {{"support", std::int64_t{5}},
                                              {"order", std::int64_t{order}},
                                              {"impacts", std::string("poisson")},
                                              {"mni", mni}});
      std::vector<Image> samples;
      for (std::uint64_t seed = 0; seed < 8; ++seed) samples.push_back(model->synthesize(domain, Seed{seed}));
      return measure_samples(*metric.of_limit(*model, domain, Seed{1}), samples, domain).value;
    };
    const double limit = of(1000);
    EXPECT_LT(limit, 0.02) << order;
    EXPECT_GT(of(1), 2 * limit) << order;
  }
}

TEST_F(TextonQuality, OfSplinesIsThatOfTheirNoise) {
  const std::map<std::string, ParamValue> support{{"support", std::int64_t{9}}};
  const auto sot = fit("sot", support);
  for (const int order : {0, 1, 3}) {
    std::map<std::string, ParamValue> given = support;
    given["order"] = std::int64_t{order};
    const auto model = fit("texton_noise", given);
    const double error = relative_model_error(model->gaussian()->spectrum({26, 22}), target_.gaussian.spectrum);
    EXPECT_NEAR(*rme(*model, target_, domain_), error, 1e-12);
    const double variance = *kept_variance(*model, target_, domain_);
    EXPECT_LT(variance, 1);
    EXPECT_NEAR(variance, *kept_variance(*sot, target_, domain_), 0.1) << order;
    EXPECT_GE(*rme_corrected(*model, target_, domain_), error - 1e-6);
    EXPECT_GT(*kernel_kurtosis(*model, target_, domain_), 1);
    EXPECT_NEAR(*poisson_impacts(*model, target_, domain_), *kernel_kurtosis(*model, target_, domain_) / 0.1, 1e-9);
    EXPECT_FALSE(stratified_impacts(*model, target_, domain_));
    EXPECT_EQ(rme_bound(*model, target_, domain_).has_value(), order == 0);
    if (order == 0) {
      EXPECT_EQ(variance, *kept_variance(*sot, target_, domain_));
      EXPECT_EQ(*rme_corrected(*model, target_, domain_), *rme_corrected(*sot, target_, domain_));
      EXPECT_NEAR(*kernel_kurtosis(*model, target_, domain_), *kernel_kurtosis(*sot, target_, domain_), 1e-9);
    }
  }
}

TEST_F(TextonQuality, AModelWithoutATextonHasNone) {
  const auto model = fit("adsn", {});
  for (const auto metric : {kept_variance, rme_corrected, rme_bound, kernel_kurtosis, predicted_kurtosis,
                            local_kurtosis_least, local_kurtosis_greatest, poisson_impacts, stratified_impacts}) {
    EXPECT_FALSE(metric(*model, target_, domain_));
  }
}

}  // namespace textonbench::texton_quality_test
