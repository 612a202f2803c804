// Metrics of local random-phase noise: numbers that are known otherwise.
#include "experiments/metrics/lrp_identities.h"

#include <gtest/gtest.h>

#include "methods/sparse/lrp.h"
#include "methods/spectral/adsn.h"
#include "tests/texture.h"

namespace textonbench {
namespace {

using LrpMetric = std::optional<double> (*)(const Model&, const Target&, const Domain&);

double measure(LrpMetric metric, const LrpOptions& options, Extent size = {40, 36}) {
  const Exemplar exemplar = test_exemplar(size, 1);
  const auto model = make_lrp(analyze_lrp(exemplar, options, Seed{1}));
  const std::optional<double> value = metric(*model, make_target(exemplar), {.size = size});
  EXPECT_TRUE(value.has_value());
  return value.value_or(-1);
}

TEST(LrpIdentities, WindowsAndEnvelope) {
  EXPECT_EQ(measure(lrp_most_windows, {}), 9);
  EXPECT_EQ(measure(lrp_least_windows, {}), 4) << "in the middle of four lattice points, the others are 1.58 away";
  EXPECT_NEAR(measure(lrp_envelope_ripple, {}), 0.0377, 5e-4);
  EXPECT_EQ(measure(lrp_variance_ripple, {}), 0);
  LrpOptions lattice;
  lattice.even_variance = false;
  EXPECT_NEAR(measure(lrp_variance_ripple, lattice), 0.852, 0.002);
}

TEST(LrpIdentities, WindowAsPrintedAndConverged) {
  LrpOptions printed;
  printed.strata.window = LrpWindow::printed;
  EXPECT_EQ(measure(lrp_window_error, {}), 0);
  EXPECT_NEAR(measure(lrp_window_error, printed), 0.02, 0.01);
  EXPECT_GT(measure(lrp_five_terms_error, {}), 0.01);
  EXPECT_NEAR(measure(lrp_radial_energy, {}), 0.11259, 1e-5);
  EXPECT_NEAR(measure(lrp_erosion_energy, {}), 0.75, 1e-3);
  EXPECT_LT(measure(lrp_concentration_ratio, {}), 1);
  EXPECT_NEAR(measure(lrp_leakage_exponent, {}), -1, 0.05);
}

TEST(LrpIdentities, StrataAndCalls) {
  LrpOptions printed;
  printed.amplitude = LrpAmplitude::printed;
  printed.strata.kept = 1;
  EXPECT_LT(measure(lrp_stratum_variance_error, {}), 1e-4);
  EXPECT_GT(measure(lrp_stratum_variance_error, printed), 0.3);
  LrpOptions lattice;
  lattice.even_variance = false;
  EXPECT_LT(measure(lrp_stratum_variance_error, lattice), 1e-4);
  EXPECT_LE(measure(lrp_strata_imbalance, {}), 1);
  EXPECT_NEAR(measure(lrp_coverage, {}), 1.6, 0.02);
  LrpOptions simple;
  simple.strata = {.strata = 1, .cosines = 3};
  EXPECT_EQ(measure(lrp_calls, simple), 36);
  EXPECT_EQ(measure(lrp_calls, {}), 486);
  EXPECT_EQ(measure(lrp_calls_ratio, {}), 1);
}

TEST(LrpIdentities, NeedLocalRandomPhaseNoise) {
  const Exemplar exemplar = test_exemplar({40, 36}, 1);
  const auto model = fit_adsn(exemplar, {});
  const Target target = make_target(exemplar);
  for (const LrpMetric metric :
       {lrp_least_windows, lrp_most_windows, lrp_envelope_ripple, lrp_variance_ripple, lrp_leakage_exponent,
        lrp_window_error, lrp_five_terms_error, lrp_concentration_ratio, lrp_radial_energy, lrp_stratum_variance_error,
        lrp_strata_imbalance, lrp_erosion_energy, lrp_coverage, lrp_calls, lrp_calls_ratio}) {
    EXPECT_FALSE(metric(*model, target, {.size = {40, 36}}).has_value());
  }
}

}  // namespace
}  // namespace textonbench
