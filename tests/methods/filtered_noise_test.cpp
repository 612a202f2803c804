#include "methods/spot/filtered_noise.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

#include "tests/texture.h"

namespace textonbench::filtered_noise_test {

using testing::HasSubstr;
using Given = std::map<std::string, ParamValue>;

Params params_of(std::string_view method, const Given& given) {
  Given options{{"support", std::int64_t{9}}};
  options.insert(given.begin(), given.end());
  return Params(find_method(method).params, options);
}

std::unique_ptr<Model> fit(const Exemplar& exemplar, const Given& given) {
  return find_method("filtered_noise").analyze({exemplar}, params_of("filtered_noise", given), Seed{1});
}

std::string refusal(const Exemplar& exemplar, const Given& given, const Domain& domain) {
  return find_method("filtered_noise").refuses({exemplar}, params_of("filtered_noise", given), domain).value_or("");
}

double rms_distance(const Image& a, const Image& b) {
  double sum = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) sum += std::pow(a.at(0, x, y) - b.at(0, x, y), 2);
  }
  return std::sqrt(sum / static_cast<double>(a.extent().area()));
}

TEST(FilteredNoiseTest, FromAboveAndUnfilteredItIsTextonNoise) {
  const Exemplar exemplar = test_exemplar({40, 40}, 3);
  const Domain window{.size = {30, 20}, .origin = {-7, 2.5}, .step = 0.75};
  const auto texton_noise = find_method("texton_noise").analyze({exemplar}, params_of("texton_noise", {}), Seed{1});
  const auto model = fit(exemplar, {{"view", std::string("plane")}, {"filter", std::string("none")}});
  EXPECT_LT(rms_distance(model->synthesize(window, Seed{3}), texton_noise->synthesize(window, Seed{3})), 1e-6);
}

TEST(FilteredNoiseTest, TheGroundEndsInWhite) {
  const Exemplar exemplar = test_exemplar({40, 40}, 3);
  const Image picture = fit(exemplar, {})->synthesize({.size = {64, 48}}, Seed{2});
  EXPECT_EQ(picture.at(0, 0, 0), 1);
  EXPECT_EQ(picture.at(2, 63, 0), 1);
  EXPECT_NE(picture.at(0, 32, 24), 1);
  EXPECT_NE(picture.at(0, 0, 47), 1);
}

TEST(FilteredNoiseTest, TheReferenceIsTheSupersampledView) {
  const Exemplar exemplar = test_exemplar({40, 40}, 1);
  const Domain view{.size = {64, 48}};
  const auto supersampled = fit(exemplar, {{"filter", std::string("supersampled")}});
  EXPECT_EQ(supersampled->reference(), nullptr);
  const Image expected = supersampled->synthesize(view, Seed{5});
  const auto error = [&](const char* filter) {
    const auto model = fit(exemplar, {{"filter", std::string(filter)}});
    EXPECT_EQ(rms_distance(model->reference()->synthesize(view, Seed{5}), expected), 0) << filter;
    return rms_distance(model->synthesize(view, Seed{5}), expected);
  };
  const double unfiltered = error("none");
  EXPECT_LT(error("ewa"), 0.35 * unfiltered);
  EXPECT_LT(error("anisotropic"), 0.5 * unfiltered);
  EXPECT_LT(error("trilinear"), unfiltered);
}

TEST(FilteredNoiseTest, TellsWhatAPixelCosts) {
  const Exemplar exemplar = test_exemplar({40, 40}, 1);
  const Domain view{.size = {64, 48}};
  const auto operations = [&](const char* filter) {
    return fit(exemplar, {{"filter", std::string(filter)}})->footprint(view).operations_per_pixel;
  };
  EXPECT_NEAR(operations("supersampled"), 400 * operations("none"), 1e-6 * operations("supersampled"));
  EXPECT_GT(operations("anisotropic"), operations("none"));
  // 5 impacts of 4 texels, an addition and a multiplication each, on the pixels that show ground.
  EXPECT_LT(operations("none"), 40);
  EXPECT_GT(operations("none"), 20);
}

TEST(FilteredNoiseTest, WhatDoesNotFitIsRefusedWithTheReason) {
  const Exemplar exemplar = test_exemplar({40, 40}, 3);
  const Domain window{.size = {20, 20}};
  EXPECT_EQ(refusal(exemplar, {}, window), "");
  EXPECT_THAT(refusal(exemplar, {{"order", std::int64_t{3}}}, window), HasSubstr("expected 1"));
  EXPECT_THAT(refusal(exemplar, {}, {.size = {20, 20}, .origin = {3, 0}}), HasSubstr("starts at (0, 0)"));
  EXPECT_THAT(refusal(exemplar, {}, {.size = {20, 20}, .periodic = true}), HasSubstr("torus"));
  EXPECT_THAT(refusal(exemplar, {}, {.size = {20, 20}, .step = 5}), HasSubstr("serve up to 256"));
  EXPECT_THAT(refusal(exemplar, {{"view", std::string("plane")}}, {.size = {20, 20}, .step = 300}),
              HasSubstr("serve up to 256"));
  EXPECT_EQ(refusal(exemplar, {{"view", std::string("plane")}}, {.size = {20, 20}, .origin = {3, 0}, .step = 5}), "");
}

}  // namespace textonbench::filtered_noise_test
