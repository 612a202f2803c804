// Gabor noise by example: what its fits keep of the exemplar, and its mixtures of Gaussians.
#include "methods/sparse/gabor_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "methods/method.h"
#include "methods/sparse/gabor.h"
#include "methods/sparse/gabor_mixture.h"
#include "methods/sparse/gabor_spectrum.h"
#include "tests/texture.h"

namespace textonbench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int fit_side = 48;

/// Correlated colors with waves, one of them shifted between the channels.
Exemplar wavy_exemplar(double change = 0) {
  Exemplar exemplar = test_exemplar({fit_side, fit_side}, 3);
  const Image other = test_texture({fit_side, fit_side}, 3, 99);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < fit_side; ++y) {
      for (int x = 0; x < fit_side; ++x) {
        const double turn = 2 * std::numbers::pi * (9.0 * x + 5.0 * y) / fit_side + c;
        float& v = exemplar.pixels.at(c, x, y);
        v += static_cast<float>(0.08 * std::cos(turn) + change * (double{other.at(c, x, y)} - 0.5));
      }
    }
  }
  return exemplar;
}

GaborFit pursuit_fit(const GaborTarget& target) { return fit_pursuit(target, {.bands = 4}, {}); }

Eigen::MatrixXcd sum_of_parts(const GaborFit& fit, int channels) {
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(channels, channels);
  for (const FittedBand& band : fit.bands) {
    for (const Eigen::MatrixXcd& part : band.part) sum += part;
  }
  return sum;
}

TEST(GaborTarget, HasTheExemplarsCovariance) {
  const Exemplar exemplar = wavy_exemplar();
  const GaborTarget target = gabor_target(exemplar, 256);
  EXPECT_EQ(target.raster(), (Extent{fit_side, fit_side}));
  EXPECT_EQ(target.scatter, 1);
  double power = 0;
  for (int y = 0; y < fit_side; ++y) {
    for (const float v : target.power.row(0, y)) power += double{v};
  }
  EXPECT_NEAR(power, target.covariance().trace(), 1e-6 * power);
  const GaborTarget blocks = gabor_target(exemplar, 40);
  EXPECT_EQ(blocks.raster(), (Extent{32, 32}));
  EXPECT_LT(blocks.scatter, 1);
  // Blocks are not the periodic component.
  EXPECT_NEAR(blocks.covariance().trace(), power, 0.5 * power);
}

TEST(GaborFit, PartsSumToTheCovarianceOfTheColors) {
  const GaborTarget target = gabor_target(wavy_exemplar(), 256);
  const GaborFit pursuit = pursuit_fit(target);
  for (const GaborFit& fit : {pursuit, fit_mixture(target, pursuit, {.kernels = 6})}) {
    const Eigen::MatrixXd covariance = target.covariance();
    EXPECT_LT((sum_of_parts(fit, 3).real() - covariance).norm(), 0.02 * covariance.norm());
    const GaborField field = fitted_field(fit, 3, {});
    EXPECT_LT((gabor_covariance(field) - sum_of_parts(fit, 3).real()).norm(), 1e-3 * covariance.norm());
  }
}

/// The wave of 9 and 5 turns lags by one radian from channel to channel.
TEST(GaborFit, ColorsKeepThePhaseBetweenChannelsAndAxesDoNot) {
  const GaborTarget target = gabor_target(wavy_exemplar(), 256);
  const GaborFit fit = pursuit_fit(target);
  for (const bool axes : {false, true}) {
    const GaborField field = fitted_field(fit, 3, {.axes = axes});
    const CrossSpectrum spectrum = gabor_spectrum(field, {fit_side, fit_side});
    std::complex<double> product = 0;
    for (const Spectrum& factor : spectrum.factors) {
      product += std::complex<double>(factor.at(1, 9, 5)) * std::conj(std::complex<double>(factor.at(0, 9, 5)));
    }
    EXPECT_NEAR(std::arg(product), axes ? 0 : 1, 0.15) << axes;
    EXPECT_LT((gabor_covariance(field) - sum_of_parts(fit, 3).real()).norm(), 1e-3 * gabor_covariance(field).norm());
  }
}

TEST(GaborFit, MixtureNeedsFewerKernelsAtEqualError) {
  const GaborTarget target = gabor_target(wavy_exemplar(), 256);
  const GaborFit pursuit = pursuit_fit(target), mixture = fit_mixture(target, pursuit, {.kernels = 6});
  EXPECT_LE(mixture.kernels(), 6U);
  EXPECT_GT(pursuit.kernels(), 3 * mixture.kernels());
  EXPECT_LT(mixture.rme.back(), pursuit.rme.back() + 0.02);
  EXPECT_LT(mixture.rme.back(), mixture.rme.front());
}

/// A change by a hundredth moves a pursuit by three, and a mixture, whose kernels may then merge in another order, by
/// thirteen: less than half of its distance from the exemplar.
TEST(GaborFit, ChangesLittleWithTheExemplar) {
  for (const bool is_mixture : {false, true}) {
    const auto spectrum = [&](double change) {
      const GaborTarget target = gabor_target(wavy_exemplar(change), 256);
      GaborFit fit = pursuit_fit(target);
      if (is_mixture) fit = fit_mixture(target, fit, {.kernels = 12});
      return gabor_spectrum(fitted_field(fit, 3, {}), {fit_side, fit_side});
    };
    EXPECT_LT(relative_model_error(spectrum(0.01), spectrum(0)), is_mixture ? 0.2 : 0.05);
  }
}

TEST(GaborByExample, HasTheSameBitsForAnyNumberOfThreads) {
  const Exemplar exemplar = wavy_exemplar();
  const MethodEntry& entry = find_method("gabor_by_example");
  for (const char* fit : {"pursuit", "mixture"}) {
    const Params params(entry.params, {{"fitter", std::string(fit)}, {"kernels", std::int64_t{6}}});
    const auto sample = [&] {
      return entry.analyze({exemplar}, params, Seed{1})->synthesize({.size = {40, 30}}, Seed{2});
    };
    const Image many = sample();
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const Image one = sample();
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 30; ++y) EXPECT_TRUE(std::ranges::equal(one.row(c, y), many.row(c, y))) << fit;
    }
  }
}

TEST(GaborByExample, IsRefusedWhereItsFitDoesNotConvergeUnlessForced) {
  const Exemplar exemplar = wavy_exemplar();
  const MethodEntry& entry = find_method("gabor_by_example");
  const auto analyze = [&](bool force) {
    return entry.analyze({exemplar}, Params(entry.params, {{"iterations", std::int64_t{3}}, {"force", force}}),
                         Seed{1});
  };
  EXPECT_THAT([&] { static_cast<void>(analyze(false)); },
              ThrowsMessage<std::runtime_error>(HasSubstr("no convergence within 3 iterations")));
  const std::unique_ptr<Model> forced = analyze(true);
  ASSERT_NE(forced->convergence(), nullptr);
  EXPECT_EQ(forced->convergence()->reason, "iterations");
  EXPECT_THAT(forced->warning({.size = {64, 64}}).value_or(""), HasSubstr("did not converge"));
}

TEST(GaborByExample, WarnsOfAliases) {
  const Exemplar exemplar = test_exemplar({32, 32}, 1);
  const MethodEntry& entry = find_method("gabor");
  const auto warning = [&](double frequency, double step) {
    const Params params(entry.params, {{"frequency", frequency}});
    return entry.analyze({exemplar}, params, Seed{1})->warning({.size = {64, 64}, .step = step}).value_or("");
  };
  EXPECT_EQ(warning(0.3, 1), "");
  EXPECT_THAT(warning(0.6, 1), HasSubstr("more than half a cycle a pixel"));
  EXPECT_THAT(warning(0.3, 2), HasSubstr("more than half a cycle a pixel"));
}

PowerGaussian gaussian(double weight, double x, double y, double along, double across, double angle) {
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const Eigen::Vector2d variances(along * along, across * across);
  return {weight, {x, y}, turn * variances.asDiagonal() * turn.transpose()};
}

TEST(MergeGaussians, KeepsMomentsAndMergesWhatIsAlike) {
  std::vector<PowerGaussian> all = {gaussian(1, 0.2, 0.1, 0.02, 0.01, 0.3), gaussian(3, -0.21, -0.1, 0.02, 0.01, 0.3),
                                    gaussian(2, 0.05, -0.3, 0.05, 0.01, 1)};
  const auto merged = merge_gaussians(all, 2);
  ASSERT_EQ(merged.size(), 2U);
  EXPECT_DOUBLE_EQ(merged[0].weight, 4) << "the second is the first one's neighbor on the other side";
  EXPECT_NEAR(merged[0].center.x(), (0.2 + 3 * 0.21) / 4, 1e-12);
  const Eigen::Vector2d apart(0.01, 0);
  EXPECT_LT((merged[0].covariance - all[0].covariance - 3.0 / 16 * apart * apart.transpose()).norm(), 1e-12);
  EXPECT_EQ(merge_gaussians(all, 5).size(), 3U);
}

TEST(FitGaussians, FindsThoseOfAPowerFromNearby) {
  const std::vector<PowerGaussian> planted = {gaussian(1, 0.2, 0.1, 0.04, 0.015, 0.3),
                                              gaussian(0.5, 0.05, -0.3, 0.05, 0.02, 1.2)};
  const std::vector<PowerGaussian> start = {gaussian(0.6, 0.22, 0.08, 0.03, 0.03, 0),
                                            gaussian(0.6, 0.08, -0.27, 0.03, 0.03, 0)};
  Image power = mixture_power(planted, {64, 48});
  double sum = 0;
  for (int y = 0; y < 48; ++y) {
    for (const float v : power.row(0, y)) sum += double{v};
  }
  EXPECT_NEAR(sum, 1.5, 1e-4);
  const PowerMixture found = fit_gaussians(start, power, {.least = 0.005, .most = 0.3}, 100);
  EXPECT_EQ(found.reason, "tolerance");
  EXPECT_LT(found.rme.back(), 0.01);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(found.gaussians[k].weight, planted[k].weight, 0.01);
    EXPECT_LT((found.gaussians[k].center - planted[k].center).norm(), 1e-3);
    EXPECT_LT((found.gaussians[k].covariance - planted[k].covariance).norm(), 0.03 * planted[k].covariance.norm());
  }
}

}  // namespace
}  // namespace textonbench
