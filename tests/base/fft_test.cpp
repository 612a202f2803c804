// Held to a naive transform in double precision.
#include "methods/base/fft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "methods/base/random.h"

namespace textonbench::fft_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr Extent sizes[] = {
    {1, 1}, {2, 2},   {1, 16},  {16, 1}, {1, 7},  {7, 1},   {3, 5},   {6, 10},  {10, 6},  {7, 9},
    {8, 8}, {16, 16}, {13, 11}, {31, 2}, {2, 31}, {15, 16}, {16, 15}, {37, 41}, {48, 36},
};

Image noise(Extent extent, int channels, std::uint64_t seed = 1) {
  Image image(extent, channels);
  const Stream stream = Stream(Seed{seed}).child("fft_test");
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < extent.height; ++y) {
      fill_normal(stream.child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0, image.row(c, y));
    }
  }
  return image;
}

/// exp(−2πi k / n) for k = 0 … n−1.
std::vector<std::complex<double>> roots(int n) {
  std::vector<std::complex<double>> all;
  for (int k = 0; k < n; ++k) {
    all.push_back(std::polar(1.0, -2 * std::numbers::pi * k / n));
  }
  return all;
}

/// The full W x H spectrum of a channel, row by row, by the definition in fft.h: first along x, then along y.
std::vector<std::complex<double>> naive(const Image& u, int c) {
  const int width = u.width();
  const int height = u.height();
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  const auto along_x = roots(width);
  const auto along_y = roots(height);
  std::vector<std::complex<double>> rows(static_cast<std::size_t>(u.extent().area()));
  std::vector<std::complex<double>> result(rows.size());
  for (int y = 0; y < height; ++y) {
    for (int kx = 0; kx < width; ++kx) {
      for (int x = 0; x < width; ++x) {
        rows[at(kx, y)] += static_cast<double>(u.at(c, x, y)) * along_x[static_cast<std::size_t>(kx) * x % width];
      }
    }
  }
  for (int ky = 0; ky < height; ++ky) {
    for (int y = 0; y < height; ++y) {
      for (int kx = 0; kx < width; ++kx) {
        result[at(kx, ky)] += rows[at(kx, y)] * along_y[static_cast<std::size_t>(ky) * y % height];
      }
    }
  }
  return result;
}

/// The bound that fft.h states.
double tolerance(Extent size) { return 2e-7 * std::sqrt(std::max(1.0, std::log2(static_cast<double>(size.area())))); }

void expect_naive_transform(Extent size, int channels) {
  const Image image = noise(size, channels);
  const Spectrum spectrum = forward_fft(image);
  ASSERT_EQ(spectrum.raster(), size);
  ASSERT_EQ(spectrum.channels(), channels);
  for (int c = 0; c < channels; ++c) {
    const auto exact = naive(image, c);
    double largest = 0;
    double error = 0;
    for (int ky = 0; ky < spectrum.rows(); ++ky) {
      for (int kx = 0; kx < spectrum.columns(); ++kx) {
        const std::complex<double> bin = exact[static_cast<std::size_t>(ky) * size.width + kx];
        largest = std::max(largest, std::abs(bin));
        error = std::max(error, std::abs(std::complex<double>(spectrum.at(c, kx, ky)) - bin));
      }
    }
    EXPECT_LE(error, tolerance(size) * largest) << size.width << "x" << size.height << ", channel " << c;
  }
}

TEST(ForwardFft, IsTheNaiveTransform) {
  for (const Extent size : sizes) {
    expect_naive_transform(size, 1);
    expect_naive_transform(size, 3);
  }
}

TEST(ForwardFft, IsTheNaiveTransformForAwkwardSizesToo) {
  expect_naive_transform({211, 199}, 1);
  expect_naive_transform({1021, 3}, 1);
}

TEST(ForwardFft, LeavesItsInputAlone) {
  for (const Extent size : sizes) {
    const Image image = noise(size, 3);
    const Image copy = image;
    forward_fft(image);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < size.height; ++y) {
        ASSERT_TRUE(std::ranges::equal(image.row(c, y), copy.row(c, y)));
      }
    }
  }
}

TEST(InverseFft, UndoesTheForwardTransform) {
  for (const Extent size : sizes) {
    const Image image = noise(size, 3);
    const Image back = inverse_fft(forward_fft(image));
    const Spectrum spectrum = forward_fft(image);
    const Image scaled = unnormalized_inverse_fft(size, 3, [&](int first, const ColumnBlock& block) {
      for (int c = 0; c < 3; ++c) {
        copy_columns(spectrum, c, first, block);
      }
    });
    const auto area = static_cast<double>(size.area());
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          // Normal variates are below 5, and both ways err by the forward bound.
          ASSERT_NEAR(back.at(c, x, y), image.at(c, x, y), 10 * tolerance(size));
          ASSERT_NEAR(scaled.at(c, x, y) / area, back.at(c, x, y), 1e-6);
        }
      }
    }
  }
}

TEST(InverseFft, IgnoresTheImaginaryPartOfSelfConjugateBins) {
  for (const Extent size : {Extent{8, 6}, Extent{7, 5}, Extent{8, 5}, Extent{1, 4}}) {
    Spectrum spectrum = forward_fft(noise(size, 1));
    const Image expected = inverse_fft(spectrum);
    for (int ky = 0; ky < spectrum.rows(); ++ky) {
      for (int kx = 0; kx < spectrum.columns(); ++kx) {
        if (spectrum.self_conjugate(kx, ky)) {
          EXPECT_NEAR(spectrum.at(0, kx, ky).imag(), 0, 1e-5);
          spectrum.at(0, kx, ky) += std::complex(0.0F, 50.0F);
        }
      }
    }
    const Image found = inverse_fft(spectrum);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        EXPECT_NEAR(found.at(0, x, y), expected.at(0, x, y), 1e-5) << size.width << "x" << size.height;
      }
    }
  }
}

TEST(Spectrum, MultiplicitiesCountTheFullSpectrum) {
  for (const Extent size : sizes) {
    const Image image = noise(size, 1);
    const Spectrum spectrum = forward_fft(image);
    EXPECT_EQ(spectrum.columns(), size.width / 2 + 1);
    EXPECT_EQ(spectrum.bins(), std::int64_t{spectrum.columns()} * size.height);
    std::int64_t bins = 0;
    double energy = 0;  // Parseval
    for (int ky = 0; ky < spectrum.rows(); ++ky) {
      for (int kx = 0; kx < spectrum.columns(); ++kx) {
        bins += spectrum.multiplicity(kx);
        energy += spectrum.multiplicity(kx) * std::norm(std::complex<double>(spectrum.at(0, kx, ky)));
      }
    }
    EXPECT_EQ(bins, size.area());
    double expected = 0;
    for (int y = 0; y < size.height; ++y) {
      for (const float v : image.row(0, y)) {
        expected += static_cast<double>(v) * v;
      }
    }
    EXPECT_NEAR(energy / static_cast<double>(size.area()), expected, 1e-6 * expected);
  }
}

TEST(Spectrum, SelfConjugateBinsAreTheirOwnMirrorImages) {
  for (const Extent size : sizes) {
    const Spectrum spectrum(size, 1);
    for (int ky = 0; ky < spectrum.rows(); ++ky) {
      for (int kx = 0; kx < spectrum.columns(); ++kx) {
        EXPECT_EQ(spectrum.self_conjugate(kx, ky), 2 * kx % size.width == 0 && 2 * ky % size.height == 0);
        EXPECT_EQ(spectrum.at(0, kx, ky), std::complex(0.0F, 0.0F));
      }
    }
  }
}

TEST(Spectrum, ImpossibleSizesAreRefused) {
  EXPECT_THAT([] { Spectrum({0, 4}, 1); }, ThrowsMessage<std::invalid_argument>(HasSubstr("raster of 0x4")));
  EXPECT_THAT([] { Spectrum({4, 4}, 9); }, ThrowsMessage<std::invalid_argument>(HasSubstr("9 channels: expected 1")));
  EXPECT_THAT(
      [] {
        Spectrum({1 << 30, 1 << 30}, 4);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("at most 2^40 pixels")));
}

bool same_bits(const Spectrum& a, int channel_of_a, const Spectrum& b, int channel_of_b) {
  for (int ky = 0; ky < a.rows(); ++ky) {
    const auto row = a.row(channel_of_a, ky);
    if (std::memcmp(row.data(), b.row(channel_of_b, ky).data(), row.size_bytes()) != 0) {
      return false;
    }
  }
  return true;
}

bool same_bits(const Spectrum& a, const Spectrum& b) {
  for (int c = 0; c < a.channels(); ++c) {
    if (!same_bits(a, c, b, c)) {
      return false;
    }
  }
  return true;
}

Spectrum forward_with_threads(const Image& image, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  return forward_fft(image);
}

TEST(Fft, BitsDoNotDependOnTheNumberOfThreads) {
  for (const Extent size : {Extent{64, 48}, Extent{63, 49}, Extent{65, 31}}) {
    const Image image = noise(size, 3);
    EXPECT_TRUE(same_bits(forward_with_threads(image, 1), forward_with_threads(image, 2)));
    // A channel gives the same bits wherever it lies in memory.
    Image gray(size, 1);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < size.height; ++y) {
        std::ranges::copy(image.row(c, y), gray.row(0, y).begin());
      }
      const Spectrum alone = forward_fft(gray);
      const Spectrum together = forward_fft(image);
      EXPECT_TRUE(same_bits(alone, 0, together, c));
    }
  }
}

TEST(Fft, FirstUseFromSeveralThreadsAtOnceIsSafe) {
  // Sizes that no other test uses, so that the plans are made here.
  std::vector<Image> images;
  for (int i = 0; i < 6; ++i) {
    images.push_back(noise({50 + i, 70 - i}, 3));
  }
  std::vector<std::vector<Spectrum>> spectra(8);
  std::vector<std::thread> threads;
  for (auto& mine : spectra) {
    threads.emplace_back([&] {
      for (const Image& image : images) {
        mine.push_back(forward_fft(inverse_fft(forward_fft(image))));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const auto& other : spectra) {
    for (std::size_t i = 0; i < images.size(); ++i) {
      EXPECT_TRUE(same_bits(other[i], spectra[0][i]));
    }
  }
}

TEST(GoodFftSize, IsTheLeastSmoothNumber) {
  const auto smooth = [](int n) {
    for (const int p : {2, 3, 5, 7}) {
      while (n % p == 0) {
        n /= p;
      }
    }
    return n == 1;
  };
  int expected = 1;
  for (int minimum = 1; minimum <= 20'000; ++minimum) {
    while (expected < minimum || !smooth(expected)) {
      ++expected;
    }
    ASSERT_EQ(good_fft_size(minimum), expected);
  }
  EXPECT_EQ(good_fft_size(1 << 30), 1 << 30);
  for (const int bad : {0, -5, (1 << 30) + 1}) {
    EXPECT_THAT([&] { good_fft_size(bad); }, ThrowsMessage<std::invalid_argument>(HasSubstr(std::to_string(bad))));
  }
}

}  // namespace textonbench::fft_test
