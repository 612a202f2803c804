#include "methods/spot/barycenter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "methods/base/random.h"

namespace textonbench::barycenter_test {

GaussianModel random_model(std::uint64_t seed, Extent size = {18, 15}, int channels = 3) {
  Image image(size, channels);
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < size.height; ++y) {
      fill_normal(Stream(Seed{seed}), static_cast<std::uint64_t>(100 * c + y), 0, image.row(c, y));
    }
  }
  return gaussian_model(std::move(image));
}

double distance(const GaussianModel& a, const GaussianModel& b) {
  return std::sqrt(transport_distance_squared(a.spectrum, b.spectrum));
}

TEST(BarycenterTest, LiesOnTheGeodesic) {
  const GaussianModel first = random_model(1);
  const GaussianModel second = random_model(2);
  const double whole = distance(first, second);
  ASSERT_GT(whole, 0.1);
  for (const double rho : {0.0, 0.05, 0.3, 0.5, 0.9, 1.0}) {
    const GaussianModel between = barycenter(first, second, rho);
    // Close to an end the formula is the small difference of energies near 1 in single precision.
    EXPECT_NEAR(distance(first, between), rho * whole, 2e-3) << rho;
    EXPECT_NEAR(distance(between, second), (1 - rho) * whole, 2e-3) << rho;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_DOUBLE_EQ(between.mean[c], (1 - rho) * first.mean[c] + rho * second.mean[c]);
    }
  }
}

TEST(BarycenterTest, EndsAreTheTextures) {
  const GaussianModel first = random_model(3);
  const GaussianModel second = random_model(4);
  const GaussianModel at_first = barycenter(first, second, 0);
  const GaussianModel at_second = barycenter(first, second, 1);
  const Spectrum& start = at_first.spectrum.factors.front();
  const Spectrum& end = at_second.spectrum.factors.front();
  const Spectrum& t0 = first.spectrum.factors.front();
  for (int ky = 0; ky < t0.rows(); ++ky) {
    for (int kx = 0; kx < t0.columns(); ++kx) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(end.at(c, kx, ky), second.spectrum.factors.front().at(c, kx, ky));
        EXPECT_NEAR(std::abs(start.at(c, kx, ky)), std::abs(t0.at(c, kx, ky)), 1e-5);
        // Relations between channels are those of the first texture.
        const auto relation = [&](const Spectrum& t) { return t.at(c, kx, ky) * std::conj(t.at(0, kx, ky)); };
        EXPECT_NEAR(std::abs(relation(start) - relation(t0)), 0, 1e-4);
      }
    }
  }
}

// Where the textures share no energy there is no phase to align.
TEST(BarycenterTest, FrequenciesOfOneTextureAloneStayFinite) {
  GaussianModel first = random_model(5);
  for (int c = 0; c < 3; ++c) {
    first.spectrum.factors.front().at(c, 2, 3) = 0;
  }
  const GaussianModel second = random_model(6);
  const GaussianModel between = barycenter(first, second, 0.5);
  const Spectrum& middle = between.spectrum.factors.front();
  for (int c = 0; c < 3; ++c) {
    const std::complex<float> half = second.spectrum.factors.front().at(c, 2, 3) * 0.5F;
    EXPECT_NEAR(std::abs(middle.at(c, 2, 3) - half), 0, 1e-6);
  }
}

TEST(BarycenterTest, WhatDoesNotFitIsRefused) {
  EXPECT_THROW(barycenter(random_model(1), random_model(2, {16, 15}), 0.5), std::invalid_argument);
  EXPECT_THROW(barycenter(random_model(1), random_model(2, {18, 15}, 1), 0.5), std::invalid_argument);
  EXPECT_THROW(barycenter(random_model(1), random_model(2), 1.5), std::invalid_argument);
  EXPECT_THROW(barycenter(random_model(1), random_model(2), NAN), std::invalid_argument);
}

}  // namespace textonbench::barycenter_test
