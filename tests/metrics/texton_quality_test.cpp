#include "experiments/metrics/texton_quality.h"

#include <gtest/gtest.h>

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
  for (const auto metric :
       {kept_variance, rme_corrected, rme_bound, kernel_kurtosis, poisson_impacts, stratified_impacts}) {
    EXPECT_FALSE(metric(*model, target_, domain_));
  }
}

}  // namespace textonbench::texton_quality_test
