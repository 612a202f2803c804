#include "methods/spot/spot_noise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <limits>
#include <numbers>

#include "methods/spot/kernel_moments.h"
#include "tests/texton.h"

namespace textonbench::spot_noise_test {

/// Σ_k Σ_x h_{k,c}(x) h_{k,d}(x + v).
double kernel_covariance(const Texton& texton, int c, int d, int vx, int vy) {
  double sum = 0;
  for (const Image& kernel : texton.kernels) {
    for (int y = std::max(0, -vy); y < kernel.height() - std::max(0, vy); ++y) {
      for (int x = std::max(0, -vx); x < kernel.width() - std::max(0, vx); ++x) {
        sum += static_cast<double>(kernel.at(c, x, y)) * kernel.at(d, x + vx, y + vy);
      }
    }
  }
  return sum;
}

/// (1 / |grid|) Σ_ξ P_00(ξ) cos(2π <ξ, v>).
double spectral_covariance(const CrossSpectrum& p, int vx, int vy) {
  double sum = 0;
  for (const Spectrum& factor : p.factors) {
    for (int ky = 0; ky < factor.rows(); ++ky) {
      for (int kx = 0; kx < factor.columns(); ++kx) {
        const double turn =
            static_cast<double>(kx * vx) / p.grid().width + static_cast<double>(ky * vy) / p.grid().height;
        sum += factor.multiplicity(kx) * std::norm(std::complex<double>(factor.at(0, kx, ky))) *
               std::cos(2 * std::numbers::pi * turn);
      }
    }
  }
  return sum / static_cast<double>(p.grid().area());
}

struct Sums {
  double first = 0, second = 0, third = 0, fourth = 0;
};

/// Moments about the known mean of many samples, and their standard errors from the spread between samples (which are
/// independent; pixels are not).
struct Estimate {
  double value = 0, error = 0;
};
Estimate estimate(const std::vector<double>& values) {
  double mean = 0;
  double square = 0;
  for (const double v : values) {
    mean += v / static_cast<double>(values.size());
    square += v * v / static_cast<double>(values.size());
  }
  return {mean, std::sqrt(std::max(0.0, square - mean * mean) / static_cast<double>(values.size()))};
}

TEST(SpotNoise, MomentsAreThoseOfTheClosedForms) {
  // Thousands of small images: threads would wait for each other.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  // Per pixel: mean, variance, third and fourth cumulant; 5.5 standard errors of a nearly normal mean of 250 samples
  // are left with probability 4e-8 each, below 1e-5 in all.
  const Texton texton = test_texton({7, 6}, 2, 2);
  const auto covariance = [&](int c, int d) { return kernel_covariance(texton, c, d, 0, 0); };
  for (const Impacts impacts : {Impacts::poisson, Impacts::stratified, Impacts::gaussian}) {
    for (const double mni : {1.0, 10.0, 100.0, 1000.0}) {
      const auto model = make_spot_noise(texton, {.impacts = impacts, .mni = mni});
      const Domain domain{.size = {32, 32}, .origin = {-40, 3}};
      std::vector<NoiseMoments> promised(2);
      if (impacts == Impacts::poisson) promised = poisson_moments(texton, mni);
      if (impacts == Impacts::stratified) promised = StratifiedMoments(texton).on(plane_lattice(mni / 42));
      std::vector<double> first[2], second[2], cross, third[2], fourth[2];
      for (std::uint64_t seed = 0; seed < 250; ++seed) {
        const Image sample = model->synthesize(domain, Seed{seed});
        Sums sums[2];
        double product = 0;
        for (int y = 0; y < 32; ++y) {
          for (int x = 0; x < 32; ++x) {
            double z[2];
            for (int c = 0; c < 2; ++c) {
              const auto i = static_cast<std::size_t>(c);
              z[c] = (sample.at(c, x, y) - texton.mean[i]) / std::sqrt(covariance(c, c));
              sums[c].first += z[c] / 1024;
              sums[c].second += z[c] * z[c] / 1024;
              sums[c].third += z[c] * z[c] * z[c] / 1024;
              sums[c].fourth += z[c] * z[c] * z[c] * z[c] / 1024;
            }
            product += z[0] * z[1] / 1024;
          }
        }
        for (int c = 0; c < 2; ++c) {
          first[c].push_back(sums[c].first);
          second[c].push_back(sums[c].second);
          third[c].push_back(sums[c].third);
          // The variance is known to be 1: E z⁴ − 6 (E z² − 1) has the same expectation and less variance than E z⁴.
          fourth[c].push_back(sums[c].fourth - 6 * (sums[c].second - 1));
        }
        cross.push_back(product);
      }
      const auto expect_near = [&](const std::vector<double>& values, double expected, const char* what) {
        const Estimate found = estimate(values);
        EXPECT_NEAR(found.value, expected, 5.5 * found.error) << what << ", MNI " << mni;
      };
      for (int c = 0; c < 2; ++c) {
        expect_near(first[c], 0, "mean");
        expect_near(second[c], 1, "variance");
        expect_near(third[c], promised[static_cast<std::size_t>(c)].skewness, "skewness");
        expect_near(fourth[c], 3 + promised[static_cast<std::size_t>(c)].excess_kurtosis, "excess kurtosis");
      }
      expect_near(cross, covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)), "color covariance");
    }
  }
}

TEST(SpotNoise, CovarianceIsThatOfTheKernelsAndVanishesOutsideTheSupportsDifference) {
  // Thousands of small images: threads would wait for each other.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  // Lag by lag against Σ_k Σ_x h_k(x) h_k(x + v), summed directly. Of 6 models 143 lags each; 6 standard errors.
  const Texton texton = test_texton({5, 4}, 1, 3);
  for (const bool periodic : {true, false}) {
    for (const Impacts impacts : {Impacts::poisson, Impacts::stratified, Impacts::gaussian}) {
      const auto model = make_spot_noise(texton, {.impacts = impacts, .mni = 4.7});
      const Domain domain{.size = {53, 47}, .periodic = periodic};
      std::vector<double> found[13][11];
      for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const Image sample = model->synthesize(domain, Seed{seed});
        for (int vy = -5; vy <= 5; ++vy) {
          for (int vx = -6; vx <= 6; ++vx) {
            double sum = 0;
            for (int y = 5; y < 42; ++y) {
              for (int x = 6; x < 47; ++x) sum += (sample.at(0, x, y) - 0.3) * (sample.at(0, x + vx, y + vy) - 0.3);
            }
            found[vx + 6][vy + 5].push_back(sum / (37 * 41));
          }
        }
      }
      for (int vy = -5; vy <= 5; ++vy) {
        for (int vx = -6; vx <= 6; ++vx) {
          const double expected = kernel_covariance(texton, 0, 0, vx, vy);
          const Estimate lag = estimate(found[vx + 6][vy + 5]);
          ASSERT_NEAR(lag.value, expected, 6 * lag.error) << vx << " " << vy << " " << periodic;
        }
      }
    }
  }
}

TEST(SpotNoise, PixelsFurtherApartThanTheSupportShareNoImpact) {
  // Exactly: a kernel of one texton is moved to zero outside S, so without an impact in x − S pixel x is the constant.
  Texton texton = test_texton({5, 4}, 1, 1);
  const auto model = make_spot_noise(texton, {.mni = 0.01, .route = SpotRoute::direct});
  const Image sample = model->synthesize({.size = {400, 400}}, Seed{2});
  int touched = 0;
  for (int y = 0; y < 400; ++y) {
    for (int x = 0; x < 400; ++x) touched += sample.at(0, x, y) != sample.at(0, 0, 0) ? 1 : 0;
  }
  // 80 impacts of 20 pixels expected.
  EXPECT_GT(touched, 20 * 30);
  EXPECT_LT(touched, 20 * 140);
}

TEST(SpotNoise, TorusAndPlaneOfOneSeedAgreeAwayFromTheWrappedKernels) {
  const Texton texton = test_texton({9, 7}, 3, 2);
  for (const double mni : {2.0, 30.0, 600.0}) {
    const auto model = make_spot_noise(texton, {.mni = mni, .route = SpotRoute::direct});
    const Image torus = model->synthesize({.size = {61, 43}, .periodic = true}, Seed{4});
    const Image plane = model->synthesize({.size = {61, 43}}, Seed{4});
    for (int c = 0; c < 3; ++c) {
      for (int y = 6; y < 43; ++y) {
        for (int x = 8; x < 61; ++x) ASSERT_EQ(torus.at(c, x, y), plane.at(c, x, y)) << x << " " << y;
      }
    }
    EXPECT_NE(torus.at(0, 2, 2), plane.at(0, 2, 2));
  }
  // The law of a crop is the plane's as soon as no lag of the crop wraps; a torus that barely holds the kernel is not.
  // The covariance of the torus is the plane's as soon as no lag wraps, and not on one that barely holds the kernel.
  const auto model = make_spot_noise(texton, {});
  const double on_plane = kernel_covariance(texton, 0, 0, 3, 2);
  EXPECT_NEAR(spectral_covariance(model->gaussian()->spectrum({17, 13}), 3, 2), on_plane, 1e-6);
  EXPECT_GT(std::fabs(spectral_covariance(model->gaussian()->spectrum({9, 7}), 3, 2) - on_plane), 0.01);
}

TEST(SpotNoise, WindowsAndThreadsGiveTheSameBits) {
  for (const Texton& texton : {test_texton({21, 19}, 3, 2), disc_texton(9, 3)}) {
    for (const Impacts impacts : {Impacts::poisson, Impacts::stratified}) {
      const auto model = make_spot_noise(texton, {.impacts = impacts, .mni = 20, .route = SpotRoute::direct});
      const Domain first{.size = {150, 130}, .origin = {16000 - 40, -50}};
      const Domain second{.size = {64, 64}, .origin = {16000, -20}};
      Image a;
      {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        a = model->synthesize(first, Seed{5});
      }
      const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
      const Image again = model->synthesize(first, Seed{5});
      const Image b = model->synthesize(second, Seed{5});
      for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < 130; ++y) {
          ASSERT_EQ(std::memcmp(a.row(c, y).data(), again.row(c, y).data(), 150 * sizeof(float)), 0);
        }
        for (int y = 0; y < 64; ++y) {
          ASSERT_EQ(std::memcmp(&a.row(c, y + 30)[40], b.row(c, y).data(), 64 * sizeof(float)), 0) << y;
        }
      }
    }
  }
}

void expect_error(const auto& work, const std::string& part) {
  try {
    work();
    ADD_FAILURE() << "no error, expected one with: " << part;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(SpotNoise, RefusesWhatItCannotSum) {
  const Texton texton = test_texton({5, 4}, 1, 2);
  for (const double mni :
       {0.0, -3.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    expect_error([&] { make_spot_noise(texton, {.mni = mni}); }, "mni = ");
  }
  expect_error([&] { make_spot_noise(texton, {.mni = 1e15}); }, "expected 1e-12 to 1000000000000 for poisson");
  expect_error([&] { make_spot_noise(texton, {.impacts = Impacts::stratified, .mni = 1e5}); }, "for stratified");
  EXPECT_NO_THROW(make_spot_noise(texton, {.mni = 1e13})->synthesize({.size = {32, 32}}, Seed{1}));
  Texton bad = texton;
  bad.kernels[1] = Image({5, 5}, 1);
  expect_error([&] { make_spot_noise(bad, {}); }, "5x4x1 and 5x5x1");
  bad = texton;
  bad.kernels[1].at(0, 2, 3) = std::numeric_limits<float>::infinity();
  expect_error([&] { make_spot_noise(bad, {}); }, "inf at (2, 3)");
  bad = texton;
  for (Image& kernel : bad.kernels) kernel = Image({5, 4}, 1);
  expect_error([&] { make_spot_noise(bad, {}); }, "zero everywhere");
  bad = texton;
  bad.support_pixels = 21;
  expect_error([&] { make_spot_noise(bad, {}); }, "support of 21 pixels");
  bad = texton;
  bad.mean.push_back(0);
  expect_error([&] { make_spot_noise(bad, {}); }, "2 means");
  bad.kernels.clear();
  expect_error([&] { make_spot_noise(bad, {}); }, "without kernels");
  const auto model = make_spot_noise(texton, {});
  expect_error([&] { model->synthesize({.size = {4, 9}, .periodic = true}, Seed{1}); }, "torus of 4x9");
  expect_error([&] { model->synthesize({.size = {9, 9}, .origin = {1, 0}, .periodic = true}, Seed{1}); }, "(1, 0)");
  expect_error([&] { model->synthesize({.size = {9, 9}, .origin = {0.5, 0}}, Seed{1}); }, "whole");
}

TEST(SpotNoise, OptionsComeFromParams) {
  const auto specs = spot_noise_params("stratified");
  const SpotNoiseOptions defaults = spot_noise_options(Params(specs, {}), 100);
  EXPECT_EQ(defaults.impacts, Impacts::stratified);
  EXPECT_EQ(defaults.mni, 30);
  EXPECT_EQ(defaults.route, SpotRoute::automatic);
  const SpotNoiseOptions given = spot_noise_options(
      Params(specs, {{"intensity", 0.5}, {"impacts", std::string("gaussian")}, {"route", std::string("spectral")}}),
      100);
  EXPECT_EQ(given.mni, 50);
  EXPECT_EQ(given.impacts, Impacts::gaussian);
  EXPECT_EQ(given.route, SpotRoute::spectral);
  EXPECT_THROW(Params(specs, {{"mni", 0.0}}), ParamError);
}

}  // namespace textonbench::spot_noise_test
