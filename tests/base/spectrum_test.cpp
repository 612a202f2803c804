#include "methods/base/spectrum.h"

#include <gtest/gtest.h>

#include <numbers>

#include "methods/base/image_io.h"
#include "tests/texture.h"

namespace textonbench::spectrum_test {

/// Sum over the neighbors of (x, y), on the torus or inside the image, of u(neighbor) − u(x, y).
double laplacian(const Image& u, int c, int x, int y, bool torus) {
  double sum = 0;
  const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  for (const auto& step : steps) {
    int nx = x + step[0];
    int ny = y + step[1];
    if (torus) {
      nx = (nx + u.width()) % u.width();
      ny = (ny + u.height()) % u.height();
    } else if (nx < 0 || ny < 0 || nx >= u.width() || ny >= u.height()) {
      continue;
    }
    sum += static_cast<double>(u.at(c, nx, ny)) - static_cast<double>(u.at(c, x, y));
  }
  return sum;
}

TEST(PeriodicComponent, HasTheInteriorLaplacianAndTheMean) {
  for (const Extent extent : {Extent{33, 20}, Extent{2, 2}, Extent{7, 1}, Extent{64, 48}}) {
    const Image u = test_texture(extent, 3);
    const Image p = periodic_component(u);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(channel_means(p)[static_cast<std::size_t>(c)], channel_means(u)[static_cast<std::size_t>(c)], 1e-7);
      for (int y = 0; y < extent.height; ++y) {
        for (int x = 0; x < extent.width; ++x) {
          ASSERT_NEAR(laplacian(p, c, x, y, true), laplacian(u, c, x, y, false), 2e-6) << extent.width << " " << x;
        }
      }
    }
  }
}

TEST(PeriodicComponent, TakesTheJumpOffARamp) {
  Image u({64, 64}, 1);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      u.at(0, x, y) = static_cast<float>(x) / 64;
    }
  }
  const Image p = periodic_component(u);
  const double jump_before = std::fabs(u.at(0, 63, 32) - u.at(0, 0, 32));
  const double jump_after = std::fabs(p.at(0, 63, 32) - p.at(0, 0, 32));
  EXPECT_LT(jump_after, 0.05 * jump_before);
}

TEST(PeriodicComponent, IsTheAuthors) {
  const auto data = folder_from("TEXTONBENCH_DATA");
  const auto reference = folder_from("TEXTONBENCH_REFERENCE");
  if (!data || !reference) {
    GTEST_SKIP() << "set TEXTONBENCH_DATA (a folder with 0000_2.png) and TEXTONBENCH_REFERENCE (with "
                    "tv_perdecomp_0000_2_f64.npy) to compare with the authors' periodic component";
  }
  const Image u = read_image(*data / "0000_2.png").image;
  const Image p = periodic_component(u);
  const std::vector<double> expected = read_npy(*reference / "tv_perdecomp_0000_2_f64.npy");
  ASSERT_EQ(expected.size(), static_cast<std::size_t>(u.extent().area() * 3));
  double largest = 0;
  for (int y = 0; y < u.height(); ++y) {
    for (int x = 0; x < u.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>((y * u.width() + x) * 3 + c);
        largest = std::max(largest, std::fabs(expected[i] - static_cast<double>(p.at(c, x, y))));
      }
    }
  }
  RecordProperty("largest_difference", std::to_string(largest));
  EXPECT_LT(largest, 2e-6);
}

TEST(PeriodicComponent, RemovesTheSpectralCross) {
  // Energy on the axes of the spectrum against that of the rows and columns two bins beside them.
  const auto cross = [](const Image& u) {
    const Image power = periodogram(u);
    double on = 0;
    double beside = 0;
    for (int k = 4; k < power.width(); ++k) {
      on += power.at(0, k, 0);
      beside += (power.at(0, k, 2) + power.at(0, k, u.height() - 2)) / 2;
    }
    return on / beside;
  };
  const Image u = test_texture({128, 128}, 1);
  Image ramp = u;
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 128; ++x) {
      ramp.at(0, x, y) += static_cast<float>(x) / 64;
    }
  }
  EXPECT_GT(cross(ramp), 10);
  EXPECT_LT(cross(periodic_component(ramp)), 2);
}

TEST(Periodogram, IntegratesToTheVariance) {
  for (const Extent extent : {Extent{16, 9}, Extent{15, 10}}) {
    const Image u = test_texture(extent, 1);
    const Image power = periodogram(u);
    const Spectrum layout(extent, 1);
    double sum = 0;
    for (int ky = 0; ky < power.height(); ++ky) {
      for (int kx = 0; kx < power.width(); ++kx) {
        sum += layout.multiplicity(kx) * static_cast<double>(power.at(0, kx, ky));
      }
    }
    const double mean = channel_means(u)[0];
    double variance = 0;
    for (int y = 0; y < extent.height; ++y) {
      for (const float v : u.row(0, y)) {
        variance += (static_cast<double>(v) - mean) * (static_cast<double>(v) - mean);
      }
    }
    const auto area = static_cast<double>(extent.area());
    EXPECT_NEAR(sum / area, variance / area, 1e-6 * variance / area);
    EXPECT_EQ(power.at(0, 0, 0), 0);
  }
}

TEST(SpectrumPictures, ShowAPlaneWaveWhereItIs) {
  Image u({32, 24}, 1);
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 32; ++x) {
      u.at(0, x, y) = static_cast<float>(0.5 + 0.2 * std::cos(2 * std::numbers::pi * (5.0 * x / 32 + 3.0 * y / 24)));
    }
  }
  const Image modulus = modulus_picture(u);
  EXPECT_FLOAT_EQ(modulus.at(0, 16 + 5, 12 + 3), 1);
  EXPECT_FLOAT_EQ(modulus.at(0, 16 - 5, 12 - 3), 1);
  EXPECT_EQ(modulus.at(0, 16, 12), 0) << "the mean is left out";
  EXPECT_LT(modulus.at(0, 20, 3), 0.01);
  EXPECT_NEAR(phase_picture(u).at(0, 16 + 5, 12 + 3), 0.5, 1e-4);
}

TEST(SpectrumPictures, TheMeanOfTwoWavesShowsBoth) {
  Image wave({32, 24}, 1), faint({32, 24}, 1);
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 32; ++x) {
      wave.at(0, x, y) = static_cast<float>(0.5 + 0.2 * std::cos(2 * std::numbers::pi * 4.0 * x / 32));
      faint.at(0, x, y) = static_cast<float>(0.5 + 0.02 * std::cos(2 * std::numbers::pi * 6.0 * y / 24));
    }
  }
  const std::vector<Image> images{wave, faint};
  const Image mean = mean_modulus_picture(images);
  EXPECT_FLOAT_EQ(mean.at(0, 16 + 4, 12), 1);
  EXPECT_FLOAT_EQ(mean.at(0, 16 - 4, 12), 1);
  EXPECT_NEAR(mean.at(0, 16, 12 + 6), 0.6, 0.03) << "power a hundred times less: two decades of five";
  EXPECT_EQ(mean.at(0, 16, 12), 0) << "means are left out";
}

}  // namespace textonbench::spectrum_test
