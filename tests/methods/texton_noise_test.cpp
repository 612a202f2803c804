#include "methods/spot/texton_noise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "methods/base/bspline.h"
#include "methods/spot/spline_spectrum.h"
#include "methods/spot/texton_error.h"
#include "tests/texture.h"

namespace textonbench::texton_noise_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::unique_ptr<Model> fit(const Exemplar& exemplar, const std::map<std::string, ParamValue>& given) {
  const MethodEntry& entry = find_method("texton_noise");
  return entry.analyze({exemplar}, Params(entry.params, given), Seed{1});
}

bool same_kernels(const Texton& a, const Texton& b) {
  if (a.kernels.size() != b.kernels.size() || a.extent() != b.extent() || a.channels() != b.channels()) {
    return false;
  }
  for (std::size_t k = 0; k < a.kernels.size(); ++k) {
    for (int i = 0; i < a.channels() * a.extent().height; ++i) {
      const int c = i / a.extent().height;
      const int y = i % a.extent().height;
      if (!std::ranges::equal(a.kernels[k].row(c, y), b.kernels[k].row(c, y))) {
        return false;
      }
    }
  }
  return true;
}

Eigen::MatrixXd wanted_colors(const Exemplar& exemplar) {
  return color_covariance(fit_spot(exemplar, SpotSource::periodic_component).spectrum);
}

/// Ledger T07.
TEST(TextonNoise, OfOrderZeroIsTheDiscreteTexton) {
  const Exemplar exemplar = test_exemplar({48, 40}, 3);
  const Support support = disc_support(6);
  const SplineTexton projected = fit_texton_noise(exemplar, support, {.order = 0}, Seed{5});
  EXPECT_TRUE(same_kernels(projected.coefficients, fit_sot(exemplar, support, {}, Seed{5}).texton));
  EXPECT_EQ(projected.support_area, static_cast<double>(support.pixels));

  const GaussianModel model = fit_spot(exemplar, SpotSource::periodic_component);
  for (const bool constrained : {false, true}) {
    const OptimalTextonOptions direct{.kernels = 2, .evaluations = 30, .keep_color_covariance = constrained};
    EXPECT_TRUE(same_kernels(
        fit_texton_noise(exemplar, support, {.order = 0, .fit = TextonFit::direct, .direct = direct}, Seed{5})
            .coefficients,
        fit_optimal_texton(model, support_image(support), direct, Seed{5}).texton));
  }
}

/// Ledger T09: a support takes variance from every channel, and the correction gives back the whole covariance.
TEST(TextonNoise, ColorsAreLostToTheSupportAndRestoredByEveryCorrection) {
  const Exemplar exemplar = test_exemplar({48, 40}, 3);
  const Eigen::MatrixXd wanted = wanted_colors(exemplar);
  for (const int order : {0, 1, 2, 3, 5}) {
    const auto colors_of = [&](const std::map<std::string, ParamValue>& given) {
      std::map<std::string, ParamValue> all = given;
      all.insert({{"support", std::int64_t{9}}, {"order", std::int64_t{order}}});
      const auto model = fit(exemplar, all);
      const SplineTexton* texton = model->spline_texton();
      return color_covariance(texton->coefficients, texton->order);
    };
    const Eigen::MatrixXd lost = colors_of({});
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT(lost(c, c), wanted(c, c)) << order;
    }
    for (const char* correction : {"authors", "transport"}) {
      for (const char* fitted_by : {"projections", "direct"}) {
        const Eigen::MatrixXd colors =
            colors_of({{"color_correction", std::string(correction)}, {"fit", std::string(fitted_by)}});
        EXPECT_LT((colors - wanted).norm(), 1e-6 * wanted.norm()) << order << correction << fitted_by;
      }
    }
    const Eigen::MatrixXd colors =
        colors_of({{"color_correction", std::string("constrained")}, {"fit", std::string("direct")}});
    EXPECT_LT((colors - wanted).norm(), 1e-6 * wanted.norm()) << order << " constrained";
  }
}

TEST(TextonNoise, ColorsOfTheTextonAreThoseOfItsSpectrum) {
  const Exemplar exemplar = test_exemplar({48, 40}, 3);
  for (int order = 0; order <= max_bspline_order; ++order) {
    const SplineTexton texton = fit_texton_noise(exemplar, square_support(9), {.order = order}, Seed{2});
    const CrossSpectrum spectrum = spline_spectrum(texton, {64, 60});  // no lag of the covariance wraps
    Eigen::MatrixXd colors = color_covariance(spectrum);
    for (int c = 0; c < 3; ++c) {
      for (int d = 0; d < 3; ++d) {
        colors(c, d) += static_cast<double>(spectrum.factors[0].at(c, 0, 0).real()) *
                        static_cast<double>(spectrum.factors[0].at(d, 0, 0).real()) / (64 * 60);
      }
    }
    EXPECT_LT((color_covariance(texton.coefficients, order) - colors).norm(), 2e-6 * colors.norm()) << order;
  }
}

/// Ledger T05.
TEST(TextonNoise, OnlyTheWholeExemplarAsSupportLeavesNoError) {
  const Exemplar exemplar = test_exemplar({32, 32}, 3);
  const CrossSpectrum target = fit_spot(exemplar, SpotSource::periodic_component).spectrum;
  for (const int order : {1, 3}) {
    const auto error = [&](int side) {
      const SplineTexton texton = fit_texton_noise(exemplar, square_support(side), {.order = order}, Seed{1});
      return relative_model_error(texton.coefficients, target, order);
    };
    EXPECT_LT(error(32), 1e-5) << order;
    EXPECT_GT(error(31), 1e-3) << order;
    EXPECT_GT(error(15), error(31)) << order;
  }
}

TEST(TextonNoise, DirectFitsHaveLessErrorAndMoreTextonsLeast) {
  const Exemplar exemplar = test_exemplar({64, 64}, 3);
  const CrossSpectrum target = fit_spot(exemplar, SpotSource::periodic_component).spectrum;
  for (const int order : {1, 3}) {
    const auto error = [&](const TextonNoiseOptions& options) {
      return relative_model_error(fit_texton_noise(exemplar, square_support(15), options, Seed{1}).coefficients, target,
                                  order);
    };
    const double projections = error({.order = order});
    const double one = error({.order = order, .fit = TextonFit::direct});
    const double four = error({.order = order, .fit = TextonFit::direct, .direct = {.kernels = 4}});
    EXPECT_LT(one, projections + 0.002) << order;
    EXPECT_LT(four, one - 0.002) << order;
  }
}

TEST(TextonNoise, AModelKnowsItsSplines) {
  const auto model = fit(test_exemplar({40, 36}, 1), {{"support", std::int64_t{4}}, {"shape", std::string("disc")}});
  ASSERT_NE(model->spline_texton(), nullptr);
  EXPECT_EQ(model->texton(), nullptr) << "no kernels of Z²";
  EXPECT_EQ(model->spline_texton()->order, 1);
  EXPECT_EQ(model->spline_texton()->coefficients.extent(), (Extent{9, 9}));
  ASSERT_NE(model->procedural(), nullptr);
  EXPECT_EQ(model->procedural()->smoothness(), 1);
}

TEST(TextonNoise, SaysWhatItCannotDo) {
  const Exemplar exemplar = test_exemplar({40, 36}, 3);
  const MethodEntry& entry = find_method("texton_noise");
  const std::vector<std::pair<std::map<std::string, ParamValue>, std::string>> cases{
      {{{"kernels", std::int64_t{2}}}, "kernels = 2: alternating projections fit one texton"},
      {{{"color_correction", std::string("constrained")}}, "alternating projections take no constraint"}};
  for (const auto& [given, reason] : cases) {
    const Params params(entry.params, given);
    EXPECT_THAT(entry.refuses({exemplar}, params, {.size = {10, 10}}).value_or(""), HasSubstr(reason));
    EXPECT_THAT([&] { entry.analyze({exemplar}, params, Seed{1}); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(reason)));
  }
  const Params rows(entry.params, {{"route", std::string("impacts")}});
  EXPECT_THAT(entry.refuses({exemplar}, rows, {.size = {10, 10}, .step = 0.5}).value_or(""), HasSubstr("step of 0.5"));
  EXPECT_FALSE(entry.refuses({exemplar}, Params(entry.params, {}), {.size = {10, 10}, .step = 0.5}));
  EXPECT_THAT(entry.refuses({exemplar}, Params(entry.params, {}), {.size = {40, 36}, .periodic = true}).value_or(""),
              HasSubstr("torus"));
  EXPECT_THROW(fit(test_exemplar({20, 16}, 3), {}), std::invalid_argument) << "a support of 31 pixels";
  EXPECT_THROW(fit(exemplar, {{"order", std::int64_t{6}}}), ParamError);
}

}  // namespace textonbench::texton_noise_test
