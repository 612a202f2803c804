#include "methods/spot/dsn.h"

#include <gtest/gtest.h>

#include <cmath>

#include "methods/base/spectrum.h"
#include "methods/spot/extended_spot.h"
#include "methods/spot/kernel_moments.h"
#include "tests/texture.h"

namespace textonbench::dsn_test {

TEST(Dsn, ItsTextonIsTheNormalizedSpot) {
  const Exemplar exemplar = test_exemplar({24, 17}, 3);
  for (const SpotSource source : {SpotSource::periodic_component, SpotSource::raw}) {
    const Image u = source == SpotSource::raw ? exemplar.pixels : periodic_component(exemplar.pixels);
    const std::vector<double> mean = channel_means(u);
    const Texton texton = exemplar_spot_texton(exemplar, source);
    EXPECT_EQ(texton.support_pixels, 24 * 17);
    for (int c = 0; c < 3; ++c) {
      const double m = mean[static_cast<std::size_t>(c)];
      EXPECT_NEAR(texton.mean[static_cast<std::size_t>(c)], m, 1e-12);
      for (int y = 0; y < 17; ++y) {
        for (int x = 0; x < 24; ++x) {
          ASSERT_NEAR(texton.kernels[0].at(c, x, y), (u.at(c, x, y) - m) / std::sqrt(24 * 17), 1e-7);
        }
      }
    }
  }
}

TEST(Dsn, HasTheLawOfAdsnToSecondOrder) {
  const Exemplar exemplar = test_exemplar({20, 14}, 3);
  const MethodEntry& dsn = find_method("dsn");
  const MethodEntry& adsn = find_method("adsn");
  const auto ours = dsn.analyze({exemplar}, Params(dsn.params, {}), Seed{1});
  const auto limit = adsn.analyze({exemplar}, Params(adsn.params, {}), Seed{1});
  for (const Extent grid : {Extent{20, 14}, Extent{45, 31}}) {
    EXPECT_LT(relative_model_error(ours->gaussian()->spectrum(grid), limit->gaussian()->spectrum(grid)), 2e-4);
  }
  ASSERT_NE(ours->texton(), nullptr);
  EXPECT_EQ(ours->texton()->extent(), (Extent{20, 14}));
}

TEST(Dsn, WithABorderItIsTheNoiseOfTheEquivalentSpot) {
  const Exemplar exemplar = test_exemplar({24, 17}, 3);
  const MethodEntry& dsn = find_method("dsn");
  const auto model = dsn.analyze({exemplar}, Params(dsn.params, {{"border", std::int64_t{5}}}), Seed{1});
  const Image spot = exemplar_spot_texton(exemplar, SpotSource::periodic_component).kernels[0];
  const Image expected = equivalent_spot(spot, {24, 17}, 5);
  const Image& kernel = model->texton()->kernels[0];
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < 24; ++x) ASSERT_EQ(kernel.at(1, x, y), expected.at(1, x, y));
  }
  EXPECT_LT(std::fabs(kernel.at(0, 0, 8)), 0.05 * std::fabs(spot.at(0, 0, 8)));
  EXPECT_THROW(dsn.analyze({exemplar}, Params(dsn.params, {{"border", std::int64_t{9}}}), Seed{1}),
               std::invalid_argument);
}

TEST(Dsn, RefusesAToruslessThanTheExemplarAndTakesAnyOther) {
  const Exemplar exemplar = test_exemplar({20, 14}, 3);
  const MethodEntry& dsn = find_method("dsn");
  const Params params(dsn.params, {{"impacts", std::string("stratified")}, {"mni", 5.0}});
  EXPECT_TRUE(dsn.refuses({exemplar}, params, {.size = {19, 40}, .periodic = true}));
  const auto model = dsn.analyze({exemplar}, params, Seed{1});
  for (const Extent size : {Extent{20, 14}, Extent{37, 53}}) {
    EXPECT_FALSE(dsn.refuses({exemplar}, params, {.size = size, .periodic = true}));
    EXPECT_EQ(model->synthesize({.size = size, .periodic = true}, Seed{1}).extent(), size);
  }
}

}  // namespace textonbench::dsn_test
