#include "methods/spot/canonical_texton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "methods/spot/texton_error.h"
#include "methods/spot/zero_phase_texton.h"
#include "tests/texture.h"

namespace textonbench::canonical_texton_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr SpotSource periodic = SpotSource::periodic_component;

TEST(CanonicalTexton, IsEvenWithItsLargestValueAtTheCenter) {
  for (const Extent extent : {Extent{32, 24}, Extent{31, 25}}) {
    const Image texton =
        canonical_texton(test_exemplar(extent, 1), periodic, rectangle_support(extent)).kernels.front();
    const int x0 = extent.width / 2;
    const int y0 = extent.height / 2;
    const float center = texton.at(0, x0, y0);
    EXPECT_GT(center, 0);
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x) {
        const int mirror_x = (2 * x0 - x + extent.width) % extent.width;
        const int mirror_y = (2 * y0 - y + extent.height) % extent.height;
        EXPECT_NEAR(texton.at(0, x, y), texton.at(0, mirror_x, mirror_y), 1e-6F * center);
        EXPECT_LE(texton.at(0, x, y), center);
      }
    }
  }
}

TEST(CanonicalTexton, OfTheWholeTorusHasTheExemplarsLaw) {
  for (const Extent extent : {Extent{32, 24}, Extent{31, 25}}) {
    const Exemplar exemplar = test_exemplar(extent, 1);
    const GaussianModel model = fit_spot(exemplar, periodic);
    const Texton texton = canonical_texton(exemplar, periodic, rectangle_support(extent));
    EXPECT_EQ(texton.support_pixels, extent.area());
    EXPECT_EQ(texton.mean, model.mean);
    EXPECT_LT(relative_model_error(texton, model.spectrum), 2e-6);
    const Autocovariance expected = autocovariance(model.spectrum);
    const Autocovariance actual = autocovariance(texton_spectrum(texton, extent));
    for (std::size_t k = 0; k < expected.planes[0].size(); ++k) {
      ASSERT_NEAR(actual.planes[0][k], expected.planes[0][k], 2e-6 * expected.planes[0][0]);
    }
  }
}

TEST(CanonicalTexton, CropKeepsTheMiddle) {
  const Exemplar exemplar = test_exemplar({32, 24}, 1);
  const Image whole = canonical_texton(exemplar, periodic, rectangle_support({32, 24})).kernels.front();
  const Texton cropped = canonical_texton(exemplar, periodic, disc_support(5));
  EXPECT_EQ(cropped.support_pixels, 81);
  for (int y = 0; y < 11; ++y) {
    for (int x = 0; x < 11; ++x) {
      const bool inside = (x - 5) * (x - 5) + (y - 5) * (y - 5) <= 25;
      EXPECT_EQ(cropped.kernels.front().at(0, x, y), inside ? whole.at(0, x + 11, y + 7) : 0.0F);
    }
  }
}

TEST(CanonicalTexton, FrequenciesWithoutPowerStayWithout) {
  // One wave: all other bins are rounding. Its texton is the cosine of the same amplitude, centered.
  Exemplar wave{"wave", Image({32, 16}, 1), ""};
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      wave.pixels.at(0, x, y) = 0.5F + 0.25F * static_cast<float>(std::sin(2 * 3.14159265358979 * 3 * x / 32.0));
    }
  }
  const Image texton = canonical_texton(wave, SpotSource::raw, rectangle_support({32, 16})).kernels.front();
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const double expected = 0.25 / std::sqrt(512) * std::cos(2 * 3.14159265358979 * 3 * (x - 16) / 32.0);
      EXPECT_NEAR(texton.at(0, x, y), expected, 1e-6);
    }
  }
}

TEST(CanonicalTexton, RefusesColorByName) {
  const Exemplar color = test_exemplar({12, 10}, 3);
  EXPECT_THAT([&] { canonical_texton(color, periodic, square_support(3)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("\"test_texture\" has 3 channels")));
  const MethodEntry& entry = find_method("canonical_texton");
  const auto reason = entry.refuses({color}, Params(entry.params, {}), {.size = {12, 10}, .periodic = true});
  ASSERT_TRUE(reason);
  EXPECT_THAT(*reason, HasSubstr("luminance_texton serves color"));
}

TEST(CanonicalTexton, SupportMustFit) {
  EXPECT_THAT(
      [] {
        canonical_texton(test_exemplar({12, 10}, 1), periodic, square_support(11));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("no more than the exemplar's 12x10")));
}

}  // namespace textonbench::canonical_texton_test
