#include "methods/spot/surface_noise.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <memory>

#include "tests/base/scratch_folder.h"
#include "tests/texture.h"

namespace textonbench::surface_noise_test {

using testing::HasSubstr;

Params params_of(const std::map<std::string, ParamValue>& given) {
  std::map<std::string, ParamValue> options{{"support", std::int64_t{9}}};
  options.insert(given.begin(), given.end());
  return Params(find_method("surface_noise").params, options);
}

std::unique_ptr<Model> fit(const Exemplar& exemplar, const std::map<std::string, ParamValue>& given) {
  return find_method("surface_noise").analyze({exemplar}, params_of(given), Seed{1});
}

std::string refusal(const Exemplar& exemplar, const std::map<std::string, ParamValue>& given, const Domain& domain) {
  return find_method("surface_noise").refuses({exemplar}, params_of(given), domain).value_or("");
}

// Covariances at lags of a grid off the pixels, from 12 samples of 300 x 300 with a correlation length of some 5
// pixels: about 40,000 independent values, so a standard error of 0.5 % of the variance.
TEST(SurfaceNoiseTest, OnThePlaneItHasTheLawOfTextonNoise) {
  const Exemplar exemplar = test_exemplar({40, 40}, 3);
  for (const char* impacts : {"stratified", "poisson"}) {
    const auto model = fit(exemplar, {{"surface", std::string("plane")}, {"impacts", std::string(impacts)}});
    ASSERT_NE(model->gaussian(), nullptr);
    const Autocovariance expected = autocovariance(model->gaussian()->spectrum({32, 32}));
    const std::vector<double> mean = model->gaussian()->mean();
    constexpr int samples = 12;
    double found[3][3] = {};
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      const Image image = model->synthesize({.size = {300, 300}, .origin = {0.25, -70.5}}, Seed{sample});
      for (int dx = 0; dx < 3; ++dx) {
        for (int d = 0; d < 3; ++d) {
          double sum = 0;
          for (int y = 0; y < 300; ++y) {
            for (int x = 0; x + dx < 300; ++x) {
              sum += (image.at(0, x, y) - mean[0]) * (image.at(d, x + dx, y) - mean[static_cast<std::size_t>(d)]);
            }
          }
          found[dx][d] += sum / (300.0 * (300 - dx)) / samples;
        }
      }
    }
    for (int dx = 0; dx < 3; ++dx) {
      for (int d = 0; d < 3; ++d) {
        EXPECT_NEAR(found[dx][d] / expected.at(0, 0, 0, 0), expected.at(d, 0, dx, 0) / expected.at(0, 0, 0, 0), 0.03)
            << impacts << ", lag " << dx << ", channel " << d;
      }
    }
  }
}

TEST(SurfaceNoiseTest, ASphereIsDrawnOnWhite) {
  const Exemplar exemplar = test_exemplar({40, 40}, 3);
  const auto model = fit(exemplar, {{"surface", std::string("sphere")}});
  EXPECT_EQ(model->gaussian(), nullptr);
  const Image picture = model->synthesize({.size = {64, 48}}, Seed{2});
  EXPECT_EQ(picture.at(0, 0, 0), 1);
  EXPECT_EQ(picture.at(2, 63, 47), 1);
  EXPECT_LT(picture.at(0, 32, 24), 0.95F);
  EXPECT_GT(picture.at(0, 32, 24), 0.2F);
}

TEST(SurfaceNoiseTest, AMeshIsReadFromItsFile) {
  const ScratchFolder folder;
  const std::string file = (folder.path() / "square.obj").string();
  std::ofstream(file) << "v 0 -1 -1\nv 0 1 -1\nv 0 1 1\nv 0 -1 1\nf 1 2 3 4\n";
  const Exemplar exemplar = test_exemplar({40, 40}, 1);
  const auto model = fit(exemplar, {{"surface", std::string("mesh")}, {"mesh", file}, {"tilt", std::int64_t{0}}});
  const Image picture = model->synthesize({.size = {60, 60}}, Seed{2});
  int covered = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 60; ++x) {
      covered += picture.at(0, x, y) != 1 ? 1 : 0;
    }
  }
  // The square's half diagonal is 0.48 of the side of the picture.
  EXPECT_NEAR(std::sqrt(covered), std::sqrt(2) * 0.48 * 60, 1.01);
}

TEST(SurfaceNoiseTest, WhatDoesNotFitIsRefusedWithTheReason) {
  const Exemplar exemplar = test_exemplar({40, 40}, 3);
  const Domain window{.size = {20, 20}};
  EXPECT_THAT(refusal(exemplar, {{"surface", std::string("mesh")}}, window), HasSubstr("-p mesh=FILE"));
  EXPECT_THAT(refusal(exemplar, {{"mesh", std::string("a.obj")}}, window), HasSubstr("expected surface = mesh"));
  EXPECT_THAT(refusal(exemplar, {}, {.size = {20, 20}, .periodic = true}), HasSubstr("not periodic"));
  EXPECT_THAT(refusal(exemplar, {}, {.size = {20, 20}, .origin = {3, 0}}), HasSubstr("starts at (0, 0)"));
  EXPECT_THAT(refusal(exemplar, {}, {.size = {20, 20}, .step = NAN}), HasSubstr("step"));
  EXPECT_EQ(refusal(exemplar, {}, window), "");
  EXPECT_THROW(fit(exemplar, {{"surface", std::string("mesh")}, {"mesh", std::string("/nowhere/a.obj")}}),
               std::invalid_argument);
}

}  // namespace textonbench::surface_noise_test
