// Metrics that test theory: near zero (or their stated value) where it holds, and far off for planted failures.
#include <gtest/gtest.h>

#include "experiments/metrics/border_cross.h"
#include "experiments/metrics/modulus_and_phase.h"
#include "experiments/metrics/transport_identities.h"
#include "tests/metrics/metric_fixture.h"

namespace textonbench::identities_test {

/// 0.869 ± 4 standard deviations over that many samples.
constexpr int samples = 32;
constexpr double kolmogorov_mean = 0.8687, kolmogorov_reach = 4 * 0.26 / 5.65;

class SampleIdentities : public testing::Test {
 protected:
  double of(std::string_view metric, const std::vector<Image>& images) const {
    return measure(metric, target_, images, domain_).value;
  }
  const Exemplar exemplar_ = smooth_exemplar({65, 48}, 3);  // one odd side
  const Target target_ = make_target(exemplar_);
  const Domain domain_{.size = {65, 48}, .periodic = true};
  const std::vector<Image> rpn_ = draw("rpn", {}, exemplar_, domain_, samples, 3);
  const std::vector<Image> adsn_ = draw("adsn", {}, exemplar_, domain_, samples, 4);
};

TEST_F(SampleIdentities, RpnHasTheModulusAndAUniformPhase) {
  EXPECT_LT(of("modulus_error", rpn_), 3e-6);
  EXPECT_NEAR(of("phase_uniformity", rpn_), kolmogorov_mean, kolmogorov_reach);
  EXPECT_GT(of("rayleigh_distance", rpn_), 20);
}

TEST_F(SampleIdentities, AdsnHasARayleighModulusAndAUniformPhase) {
  EXPECT_GT(of("modulus_error", adsn_), 0.5);
  EXPECT_NEAR(of("phase_uniformity", adsn_), kolmogorov_mean, kolmogorov_reach);
  EXPECT_NEAR(of("rayleigh_distance", adsn_), kolmogorov_mean, kolmogorov_reach);
}

TEST_F(SampleIdentities, CatchPlantedFailures) {
  std::vector<Image> louder;
  for (const Image& u : rpn_) {
    louder.push_back(mapped(u, [&](double v, int c) {
      const double m = target_.gaussian.mean[static_cast<std::size_t>(c)];
      return m + 1.01 * (v - m);
    }));
  }
  EXPECT_NEAR(of("modulus_error", louder), 0.01, 1e-4);
  // The exemplar's own phase is no random one: F_n jumps at one point in the middle, so the distance is √n / 2.
  EXPECT_NEAR(of("phase_uniformity", {target_.periodic_component}), std::sqrt(65 * 48 / 2) / 2, 0.5);
  const std::vector<Image> wrong = draw("rpn", {{"phase", std::string("replaced")}}, exemplar_, domain_, 2, 3);
  EXPECT_GT(of("rayleigh_distance", wrong), 5);
}

TEST_F(SampleIdentities, AreRefusedOnAnotherDomain) {
  const Domain plane{.size = {65, 48}, .periodic = false};
  for (const auto metric : {modulus_error, rayleigh_distance, phase_uniformity}) {
    EXPECT_THROW(metric(target_, plane, Seed{1}), std::invalid_argument);
  }
}

TEST(CircularAutocovarianceError, HoldsTheRawExemplarAgainstItsOwnTorus) {
  Exemplar exemplar = smooth_exemplar({64, 64}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) exemplar.pixels.at(c, x, y) += 0.2F * static_cast<float>(x) / 64;
    }
  }
  const Target target = make_target(exemplar);
  const Domain domain{.size = {64, 64}, .periodic = true};
  const auto raw = draw("rpn", {{"component", std::string("raw")}}, exemplar, domain, 2, 1);
  const auto periodic = draw("rpn", {}, exemplar, domain, 2, 1);
  EXPECT_LT(measure("circular_autocovariance_error", target, raw, domain).value, 1e-5);
  EXPECT_GT(measure("circular_autocovariance_error", target, periodic, domain).value, 0.1);
}

/// Value of a model-level metric for RPN of an exemplar.
double of_rpn(std::string_view metric, const Exemplar& exemplar, const std::string& component) {
  const MethodEntry& rpn = find_method("rpn");
  const auto model = rpn.analyze({exemplar}, Params(rpn.params, {{"component", component}}), Seed{1});
  const Domain domain{.size = exemplar.pixels.extent(), .periodic = true};
  return find_metric(metric).of_model(*model, make_target(exemplar), domain).value();
}

TEST(BorderCross, ARampShowsOnTheAxesAndItsPeriodicComponentDoesNot) {
  Exemplar ramp = smooth_exemplar({128, 128}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < 128; ++y) {
      for (int x = 0; x < 128; ++x) ramp.pixels.at(c, x, y) += 0.5F * static_cast<float>(x + y) / 128;
    }
  }
  EXPECT_GT(of_rpn("axis_energy_ratio", ramp, "raw"), 4 * of_rpn("axis_energy_ratio", ramp, "periodic"));
  EXPECT_GT(of_rpn("axis_power_error", ramp, "raw"), of_rpn("axis_power_error", ramp, "periodic") + 3);
  EXPECT_LT(of_rpn("periodic_laplacian_error", ramp, "periodic"), 1e-5);
}

TEST(BorderCross, TheLaplacianOfAnotherImageIsCaught) {
  const Exemplar exemplar = smooth_exemplar({40, 32}, 3);
  Target target = make_target(exemplar);
  const auto model = find_method("rpn").analyze({exemplar}, Params(find_method("rpn").params, {}), Seed{1});
  target.periodic_component.at(1, 7, 5) += 0.01F;
  EXPECT_GT(periodic_laplacian_error(*model, target, {}).value(), 0.01);
}

TEST(BorderCross, SmallExemplarsHaveNoAxes) {
  const Exemplar exemplar = smooth_exemplar({31, 64}, 1);
  const auto model = find_method("rpn").analyze({exemplar}, Params(find_method("rpn").params, {}), Seed{1});
  EXPECT_FALSE(axis_energy_ratio(*model, make_target(exemplar), {}));
  EXPECT_FALSE(axis_power_error(*model, make_target(exemplar), {}));
}

TEST(TransportIdentities, HoldOnColorCrops) {
  const Exemplar exemplar = smooth_exemplar({64, 48}, 3);
  EXPECT_LT(of_rpn("transport_identity_error", exemplar, "periodic"), 1e-5);
  const double ratio = of_rpn("window_transport_ratio", exemplar, "periodic");
  EXPECT_GT(ratio, 0.05);
  EXPECT_LE(ratio, 1);
  EXPECT_NEAR(of_rpn("projection_distance_ratio", exemplar, "periodic"), 1, 1e-5);
  EXPECT_LT(of_rpn("spot_symmetry_error", exemplar, "periodic"), 1e-5);
}

TEST(TransportIdentities, AreAbsentWhereCropsDoNotFitOrAreFlat) {
  const Exemplar small = smooth_exemplar({15, 64}, 3);
  const Exemplar flat{"flat", Image({64, 64}, 3), std::string(64, '0')};
  const auto model = find_method("rpn").analyze({small}, Params(find_method("rpn").params, {}), Seed{1});
  EXPECT_FALSE(transport_identity_error(*model, make_target(small), {}));
  const Target target = make_target(small);
  const Target of_flat{flat, flat.pixels, target.gaussian, target.covariance};
  EXPECT_FALSE(window_transport_ratio(*model, of_flat, {}));
}

TEST(TransportIdentities, AnotherPhaseThanTheProjectionIsCaught) {
  const Spectrum h = gaussian_model(white_noise({24, 24}, 3, 1)).spectrum.factors.front();
  const Spectrum t = gaussian_model(white_noise({24, 24}, 3, 2)).spectrum.factors.front();
  EXPECT_NEAR(least_distance_ratio(phase_projection(h, t), h, t, Seed{1}), 1, 1e-5);
  EXPECT_GT(least_distance_ratio(t, h, t, Seed{1}), 1.05);
}

TEST(TransportIdentities, TheDenseCovarianceIsThatOfTheField) {
  const Image spot = white_noise({8, 6}, 2, 3);
  const Eigen::MatrixXd dense = window_covariance(spot, {3, 2});
  const Autocovariance exact = autocovariance(gaussian_model(spot).spectrum);
  // Pixel (2, 1) of channel 1 against pixel (0, 1) of channel 0.
  EXPECT_NEAR(dense(6 + 5, 3), exact.at(1, 0, 2, 0), 1e-6);
  EXPECT_NEAR(dense(4, 2), exact.at(0, 0, -1, 1), 1e-6);
}

}  // namespace textonbench::identities_test
