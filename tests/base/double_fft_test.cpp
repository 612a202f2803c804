// Held to the sum that defines the transform, in double precision.
#include "methods/base/double_fft.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "methods/base/random.h"

namespace textonbench::double_fft_test {

Planes random_planes(Extent size, int channels) {
  Planes planes(size, channels);
  RandomSequence numbers(Stream(Seed{5}).child("double_fft"));
  for (double& value : planes.data) value = numbers.normal();
  return planes;
}

/// û(kx, ky) of the planes in the corner of a raster.
std::complex<double> plain_bin(const Planes& planes, Extent raster, int channel, int kx, int ky) {
  std::complex<double> sum = 0;
  for (int y = 0; y < planes.extent.height; ++y) {
    for (int x = 0; x < planes.extent.width; ++x) {
      const double turns = double(kx) * x / raster.width + double(ky) * y / raster.height;
      sum += planes.row(channel, y)[x] * std::polar(1.0, -2 * std::numbers::pi * turns);
    }
  }
  return sum;
}

struct Sizes {
  Extent raster, box;
};

class DoubleFft : public testing::TestWithParam<Sizes> {};

TEST_P(DoubleFft, ForwardIsTheSum) {
  const auto [raster, box] = GetParam();
  const Planes fields = random_planes(box, 2);
  const BoxTransform transform(raster, box);
  BoxTransform::Workspace workspace;
  int seen = 0;
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  transform.forward(
      fields,
      [&](const SpectrumColumns& block) {
        for (int i = 0; i < SpectrumColumns::count && block.first + i < transform.columns(); ++i, ++seen) {
          for (int c = 0; c < 2; ++c) {
            for (int ky = 0; ky < raster.height; ++ky) {
              EXPECT_LT(std::abs(block.column(c, i)[ky] - plain_bin(fields, raster, c, block.first + i, ky)), 1e-11);
            }
          }
        }
      },
      workspace);
  EXPECT_EQ(seen, transform.columns());
}

TEST_P(DoubleFft, MapByNothingGivesTheBoxBack) {
  const auto [raster, box] = GetParam();
  const Planes before = random_planes(box, 3);
  Planes after = before;
  BoxTransform::Workspace workspace;
  BoxTransform(raster, box)
      .map(
          after, [](const SpectrumColumns&) {}, workspace);
  for (std::size_t i = 0; i < before.data.size(); ++i) {
    ASSERT_NEAR(after.data[i] / static_cast<double>(raster.area()), before.data[i], 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, DoubleFft,
                         testing::Values(Sizes{{1, 1}, {1, 1}}, Sizes{{2, 3}, {1, 2}}, Sizes{{12, 10}, {12, 10}},
                                         Sizes{{15, 8}, {7, 5}}, Sizes{{9, 21}, {4, 1}}));

TEST(DoubleFftBits, DoNotDependOnTheThreads) {
  const auto transformed = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Planes fields = random_planes({40, 30}, 3);
    BoxTransform::Workspace workspace;
    BoxTransform({64, 60}, {40, 30})
        .map(
            fields,
            [](const SpectrumColumns& block) {
              for (int y = 0; y < block.height; ++y) block.column(0, 0)[y] *= 1.5;
            },
            workspace);
    return fields.data;
  };
  EXPECT_EQ(transformed(1), transformed(2));
}

TEST(DoubleFftErrors, BoxLargerThanTheGrid) {
  EXPECT_THROW(BoxTransform({8, 8}, {9, 3}), std::invalid_argument);
  EXPECT_THROW(BoxTransform({8, 8}, {3, 0}), std::invalid_argument);
}

}  // namespace textonbench::double_fft_test
