// Structure of fixed phases: the exemplar's own, exact with all bins and reduced to few cosines.
#include "methods/sparse/structure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "methods/base/welch.h"
#include "tests/texture.h"

namespace textonbench {
namespace {

constexpr int structure_side = 32;

Image block_of_texture(int channels) {
  Image image = test_texture({structure_side, structure_side}, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < structure_side; ++y) {
      for (float& v : image.row(c, y)) v -= 0.5F;
    }
  }
  return image;
}

PowerPlane power_of(const Image& image) {
  const WelchSpectrum spectrum(image, {.side = structure_side, .taper = Taper::none});
  PowerPlane plane(structure_side);
  for (const Pixel& bin : plane.half())
    plane.set(bin.x, bin.y, spectrum.power(bin.x, (bin.y + structure_side) % structure_side));
  return plane;
}

std::vector<float> value_at(const Structure& structure, double x, double y) {
  std::vector<float> out(static_cast<std::size_t>(structure.image().channels()));
  structure.add(
      {static_cast<std::int64_t>(std::floor(x * plane_pixel)), static_cast<std::int64_t>(std::floor(y * plane_pixel))},
      1, out.data());
  return out;
}

TEST(StrongestBins, HoldTheirPartOfThePower) {
  const PowerPlane plane = power_of(block_of_texture(3));
  EXPECT_TRUE(strongest_bins(plane, 0).empty());
  EXPECT_EQ(strongest_bins(plane, 1).size(), plane.half().size());
  for (const double ratio : {0.1, 0.5, 0.9}) {
    const auto bins = strongest_bins(plane, ratio);
    double sum = 0, weakest = INFINITY;
    for (const Pixel& bin : bins) {
      sum += plane.multiplicity(bin) * plane.at(bin.x, bin.y);
      weakest = std::min(weakest, plane.at(bin.x, bin.y));
    }
    EXPECT_GE(sum, ratio * plane.total());
    EXPECT_LE(sum, ratio * plane.total() + 2 * weakest) << "not a bin more";
    std::size_t stronger = 0;
    for (const Pixel& bin : plane.half()) stronger += plane.at(bin.x, bin.y) > weakest ? 1 : 0;
    EXPECT_LT(stronger, bins.size() + 1);
  }
}

TEST(Structure, OfAllBinsIsTheBlock) {
  for (const int channels : {1, 3}) {
    const Image image = block_of_texture(channels);
    const auto bins = strongest_bins(power_of(image), 1);
    const Structure structure(restrict_to_bins(image, bins), bins, {});
    EXPECT_EQ(structure.block_side(), structure_side);
    EXPECT_EQ(structure.cosines(), static_cast<int>(bins.size()));
    for (int y = 0; y < structure_side; ++y) {
      for (int x = 0; x < structure_side; ++x) {
        const auto value = value_at(structure, x, y),
                   far = value_at(structure, x + 3.0 * structure_side, y - 1e9 * structure_side);
        for (int c = 0; c < channels; ++c) {
          ASSERT_NEAR(value[static_cast<std::size_t>(c)], image.at(c, x, y), 1e-5);
          ASSERT_EQ(value[static_cast<std::size_t>(c)], far[static_cast<std::size_t>(c)]) << "it repeats";
        }
      }
    }
  }
}

TEST(Structure, BetweenPixelsIsTheFourierSeries) {
  const Image image = block_of_texture(1);
  const auto bins = strongest_bins(power_of(image), 0.6);
  const Structure structure(restrict_to_bins(image, bins), bins, {});
  for (const auto& [px, py] : {std::pair{3.25, 7.75}, std::pair{30.9, -2.4}}) {
    double expected = 0;
    for (const Pixel& bin : bins) {
      std::complex<double> z = 0;
      for (int y = 0; y < structure_side; ++y) {
        for (int x = 0; x < structure_side; ++x) {
          z += static_cast<double>(image.at(0, x, y)) *
               std::polar(1.0, 2 * std::numbers::pi * (bin.x * (px - x) + bin.y * (py - y)) / structure_side);
        }
      }
      expected += PowerPlane(structure_side).multiplicity(bin) * z.real() / (structure_side * structure_side);
    }
    EXPECT_NEAR(value_at(structure, px, py).front(), expected, 1e-5);
  }
}

TEST(Structure, OfFewCosinesIsCutUntilItIsPrecise) {
  const Image image = block_of_texture(3);
  const auto bins = strongest_bins(power_of(image), 0.8);
  const Image wanted = restrict_to_bins(image, bins);
  int last = structure_side + 1;
  for (const int cosines : {400, 40, 8, 2}) {
    const Structure structure(wanted, bins, {.cosines = cosines});
    EXPECT_LE(structure.deviation(), 1. / 256);
    EXPECT_LE(structure.block_side(), last) << "fewer cosines, smaller blocks";
    EXPECT_LE(structure.cosines(), cosines);
    last = structure.block_side();
    double sum = 0;
    for (int y = 0; y < structure_side; ++y) {
      for (int x = 0; x < structure_side; ++x) {
        const auto value = value_at(structure, x, y);
        for (int c = 0; c < 3; ++c) sum += std::abs(value[static_cast<std::size_t>(c)] - wanted.at(c, x, y));
      }
    }
    EXPECT_NEAR(sum / (3 * structure_side * structure_side), structure.deviation(), 1e-6);
  }
  const Structure pixels(wanted, bins, {.cosines = 1, .precision = 1e-6});
  EXPECT_EQ(pixels.block_side(), 1);
  EXPECT_LT(pixels.deviation(), 1e-6) << "blocks of one pixel are exact";
}

/// Steps of a hundredth of a pixel move a continuous structure by no more than its steepest slope tells; a jump at the
/// border of blocks would be many times that.
TEST(Structure, IsContinuousAcrossBlocks) {
  const Image image = block_of_texture(1);
  const auto bins = strongest_bins(power_of(image), 0.8);
  const Structure structure(restrict_to_bins(image, bins), bins, {.cosines = 8});
  ASSERT_LT(structure.block_side(), structure_side);
  double most = 0, mean = 0;
  float last = value_at(structure, -1, 5.3).front();
  constexpr int steps = 3400;
  for (int i = 1; i <= steps; ++i) {
    const float value = value_at(structure, -1 + 0.01 * i, 5.3).front();
    most = std::max(most, static_cast<double>(std::abs(value - last)));
    mean += static_cast<double>(std::abs(value - last)) / steps;
    last = value;
  }
  EXPECT_LT(most, 8 * mean);
}

}  // namespace
}  // namespace textonbench
