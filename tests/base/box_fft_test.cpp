// Held to the transforms of whole rasters.
#include "methods/base/box_fft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <stdexcept>

#include "methods/base/random.h"

namespace textonbench::box_fft_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct Case {
  Extent raster, box;
};
constexpr Case cases[] = {{{16, 16}, {5, 5}},  {{128, 96}, {31, 17}}, {{15, 20}, {15, 20}}, {{20, 15}, {20, 1}},
                          {{31, 37}, {1, 37}}, {{1, 9}, {1, 4}},      {{9, 1}, {3, 1}},     {{14, 64}, {14, 3}}};

Image noise(Extent extent, int channels) {
  Image image(extent, channels);
  const Stream stream = Stream(Seed{1}).child("box_fft_test");
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(stream.child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0, image.row(c, y));
    }
  }
  return image;
}

Image padded(const Image& box, Extent raster) {
  Image image(raster, box.channels());
  for (int c = 0; c < box.channels(); ++c) {
    for (int y = 0; y < box.height(); ++y) {
      std::ranges::copy(box.row(c, y), image.row(c, y).begin());
    }
  }
  return image;
}

/// The bound that fft.h states for one transform, in units of the largest coefficient.
double tolerance(Extent raster) {
  return 2e-7 * std::sqrt(std::max(1.0, std::log2(static_cast<double>(raster.area()))));
}

/// Multiplies bin (kx, ky) by a number that depends on its place and channel.
std::complex<float> factor(int c, int kx, int ky) {
  return {1.0F + 0.1F * static_cast<float>(c) + 0.01F * static_cast<float>(kx), 0.02F * static_cast<float>(ky)};
}

void multiply_block(Extent raster, int channels, int first, const BinBlock& block) {
  for (int c = 0; c < channels; ++c) {
    for (int ky = 0; ky < raster.height; ++ky) {
      for (int i = 0; i < BinBlock::width && first + i <= raster.width / 2; ++i) {
        float* bin = block.bins(c) + 16 * ky + i;
        const std::complex<float> product = std::complex(bin[0], bin[8]) * factor(c, first + i, ky);
        bin[0] = product.real();
        bin[8] = product.imag();
      }
    }
  }
}

Image multiply_whole(Spectrum spectrum) {
  for (int c = 0; c < spectrum.channels(); ++c) {
    for (int ky = 0; ky < spectrum.rows(); ++ky) {
      for (int kx = 0; kx < spectrum.columns(); ++kx) {
        spectrum.at(c, kx, ky) *= factor(c, kx, ky);
      }
    }
  }
  return inverse_fft(spectrum);
}

void expect_corner(const Image& box, const Image& whole, const Case& sizes, double bound) {
  ASSERT_EQ(box.extent(), sizes.box);
  const auto area = static_cast<double>(sizes.raster.area());
  double largest = 0;
  double error = 0;
  for (int c = 0; c < box.channels(); ++c) {
    for (int y = 0; y < sizes.box.height; ++y) {
      for (int x = 0; x < sizes.box.width; ++x) {
        largest = std::max(largest, std::fabs(static_cast<double>(whole.at(c, x, y))));
        error = std::max(
            error, std::fabs(static_cast<double>(box.at(c, x, y)) / area - static_cast<double>(whole.at(c, x, y))));
      }
    }
  }
  EXPECT_LE(error, bound * std::max(1.0, largest))
      << sizes.raster.width << "x" << sizes.raster.height << " box " << sizes.box.width << "x" << sizes.box.height;
}

TEST(BoxFft, ForwardIsThatOfThePaddedImage) {
  for (const Case& sizes : cases) {
    const Image box = noise(sizes.box, 3);
    const Spectrum expected = forward_fft(padded(box, sizes.raster));
    const Spectrum spectrum = forward_fft_of_box(box, sizes.raster);
    double largest = 0;
    double error = 0;
    for (int c = 0; c < 3; ++c) {
      for (int ky = 0; ky < expected.rows(); ++ky) {
        for (int kx = 0; kx < expected.columns(); ++kx) {
          largest = std::max(largest, static_cast<double>(std::abs(expected.at(c, kx, ky))));
          error = std::max(error, static_cast<double>(std::abs(spectrum.at(c, kx, ky) - expected.at(c, kx, ky))));
        }
      }
    }
    EXPECT_LE(error, 2 * tolerance(sizes.raster) * largest);
  }
}

TEST(BoxFft, InverseIsTheCornerOfTheWhole) {
  for (const Case& sizes : cases) {
    const Spectrum spectrum = forward_fft(noise(sizes.raster, 2));
    const Image box = unnormalized_inverse_fft_in_box(
        spectrum, sizes.box, [&](int first, const BinBlock& block) { multiply_block(sizes.raster, 2, first, block); });
    expect_corner(box, multiply_whole(spectrum), sizes, 10 * tolerance(sizes.raster));
  }
}

TEST(BoxFft, MappedSpectrumIsThatOfThePaddedImage) {
  for (const Case& sizes : cases) {
    Image box = noise(sizes.box, 3);
    const Image expected = multiply_whole(forward_fft(padded(box, sizes.raster)));
    map_box_spectrum(box, sizes.raster,
                     [&](int first, const BinBlock& block) { multiply_block(sizes.raster, 3, first, block); });
    expect_corner(box, expected, sizes, 10 * tolerance(sizes.raster));
  }
}

TEST(BoxFft, SameBitsWhateverTheThreads) {
  const auto mapped = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Image box = noise({31, 17}, 3);
    map_box_spectrum(box, {128, 96}, [](int first, const BinBlock& block) {
      multiply_block({128, 96}, 3, first, block);
    });
    return box;
  };
  const Image one = mapped(1);
  const Image two = mapped(2);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < one.height(); ++y) {
      ASSERT_EQ(std::memcmp(one.row(c, y).data(), two.row(c, y).data(), one.row(c, y).size_bytes()), 0);
    }
  }
}

TEST(BoxFft, RefusesABoxLargerThanTheRaster) {
  Image box = noise({9, 4}, 1);
  const auto says = ThrowsMessage<std::invalid_argument>(HasSubstr("box of 9x4 pixels: expected no more than"));
  EXPECT_THAT([&] { forward_fft_of_box(box, {8, 8}); }, says);
  EXPECT_THAT([&] { map_box_spectrum(box, {9, 3}, [](int, const BinBlock&) {}); }, says);
  EXPECT_THAT([&] { unnormalized_inverse_fft_in_box(Spectrum({8, 8}, 1), {9, 4}, [](int, const BinBlock&) {}); }, says);
}

}  // namespace textonbench::box_fft_test
