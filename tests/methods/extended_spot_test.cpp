#include "methods/spot/extended_spot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "methods/exemplar_spot.h"
#include "methods/spot/canonical_texton.h"
#include "tests/texture.h"

namespace textonbench::extended_spot_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

Image spot_of(Extent extent, int channels) {
  return inverse_fft(fit_spot(test_exemplar(extent, channels), SpotSource::raw).spectrum.factors.front());
}

double energy_of(const Image& image) {
  double sum = 0;
  for (int c = 0; c < image.channels(); ++c) {
    for (int y = 0; y < image.height(); ++y) {
      for (const float v : image.row(c, y)) {
        sum += static_cast<double>(v) * static_cast<double>(v);
      }
    }
  }
  return sum;
}

TEST(EquivalentSpot, KeepsTheVarianceAndFadesAtTheBorder) {
  for (const int channels : {1, 3}) {
    const Image spot = spot_of({24, 20}, channels);
    for (const int border : {0, 1, 4, 9}) {
      const Image equivalent = equivalent_spot(spot, {50, 41}, border);
      EXPECT_EQ(equivalent.extent(), (Extent{50, 41}));
      EXPECT_NEAR(energy_of(equivalent), energy_of(spot), 1e-6 * energy_of(spot));
      // The ratio to the spot is the window times one number: sin² of the distance to the border of the spot.
      const auto ratio = [&](int x, int y) { return equivalent.at(0, 13 + x, 10 + y) / spot.at(0, x, y); };
      const float inside = ratio(12, 10);
      const auto window = [&](int x) {
        return x >= border ? 1.0 : std::pow(std::sin(1.5707963267948966 * (x + 0.5) / border), 2);
      };
      for (int x = 0; x < 12; ++x) {
        EXPECT_NEAR(ratio(x, 10) / inside, window(x), 1e-5) << x;
        EXPECT_NEAR(ratio(23 - x, 3) / inside, window(x) * window(3), 1e-5) << x;
      }
      EXPECT_EQ(equivalent.at(0, 12, 20), 0);
      EXPECT_EQ(equivalent.at(0, 37, 20), 0);
    }
  }
}

TEST(EquivalentSpot, CovarianceIsThatOfTheWindowedSpot) {
  // On a raster that holds S − S, the aperiodic autocorrelation Σ_x h(x) h(x + v), summed directly.
  const Image spot = spot_of({7, 5}, 1);
  const Image windowed = equivalent_spot(spot, {7, 5}, 2);
  const Image wide = equivalent_spot(spot, {16, 12}, 2);
  CrossSpectrum spectrum;
  spectrum.factors.push_back(forward_fft(wide));
  const double mean = spectrum.factors.front().at(0, 0, 0).real();
  const Autocovariance covariance = autocovariance(spectrum);
  for (int vy = -5; vy <= 5; ++vy) {
    for (int vx = -7; vx <= 7; ++vx) {
      double sum = 0;
      for (int y = std::max(0, -vy); y < std::min(5, 5 - vy); ++y) {
        for (int x = std::max(0, -vx); x < std::min(7, 7 - vx); ++x) {
          sum += static_cast<double>(windowed.at(0, x, y)) * static_cast<double>(windowed.at(0, x + vx, y + vy));
        }
      }
      EXPECT_NEAR(covariance.at(0, 0, vx, vy), sum - mean * mean / (16 * 12), 1e-6 * energy_of(spot))
          << vx << " " << vy;
    }
  }
}

TEST(ExtendedTexton, IsTheTextonInTheMiddle) {
  const Image texton =
      canonical_texton(test_exemplar({12, 10}, 1), SpotSource::raw, rectangle_support({12, 10})).kernels.front();
  const Image extended = extended_texton(texton, {40, 33});
  EXPECT_EQ(energy_of(extended), energy_of(texton));
  EXPECT_EQ(extended.at(0, 14 + 6, 11 + 5), texton.at(0, 6, 5));
  EXPECT_EQ(extended.at(0, 13, 16), 0);
}

TEST(ExtendedSpots, RefuseWhatDoesNotFit) {
  const Image spot = spot_of({12, 10}, 1);
  const auto says = ThrowsMessage<std::invalid_argument>(HasSubstr("raster of 11x10 for a spot of 12x10"));
  EXPECT_THAT([&] { extended_texton(spot, {11, 10}); }, says);
  EXPECT_THAT([&] { equivalent_spot(spot, {11, 10}, 1); }, says);
  for (const int border : {-1, 6}) {
    EXPECT_THAT(
        [&] {
          equivalent_spot(spot, {20, 20}, border);
        },
        ThrowsMessage<std::invalid_argument>(HasSubstr("expected 0 to half its side")));
  }
}

}  // namespace textonbench::extended_spot_test
