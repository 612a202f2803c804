// Metrics of structures, estimates and copies: numbers that are known otherwise.
#include "experiments/metrics/lrp_structure.h"

#include <gtest/gtest.h>

#include "experiments/metrics/autocorrelation_peak.h"
#include "experiments/metrics/lrp_diagrams.h"
#include "experiments/metrics/lrp_estimates.h"
#include "experiments/metrics/verbatim_copy.h"
#include "methods/sparse/lrp.h"
#include "methods/sparse/lrp_suggestion.h"
#include "methods/spectral/adsn.h"
#include "tests/metrics/metric_fixture.h"
#include "tests/texture.h"

namespace textonbench {
namespace {

using LrpMetric = std::optional<double> (*)(const Model&, const Target&, const Domain&);

std::optional<double> measure(LrpMetric metric, const LrpOptions& options, const Exemplar& exemplar) {
  const auto model = make_lrp(analyze_lrp(exemplar, options, Seed{1}));
  return metric(*model, make_target(exemplar), {.size = exemplar.pixels.extent()});
}

LrpOptions with(FixedPhaseOptions fixed) {
  LrpOptions options;
  options.fixed = fixed;
  return options;
}

TEST(LrpStructure, WholeIsACopyButForThePrintedWindows) {
  const Exemplar exemplar = test_exemplar({40, 50}, 3);
  const LrpOptions whole = with({.ratio = 1, .reduced = false});
  EXPECT_LT(measure(lrp_copy_error, whole, exemplar).value(), 1e-5);
  // The windows' sum is 1.33 on average and varies by 4 %.
  EXPECT_NEAR(measure(lrp_printed_copy_error, whole, exemplar).value(), 0.33, 0.01);
  EXPECT_GT(measure(lrp_copy_error, with({.ratio = 0.1}), exemplar).value(), 0.3);
}

TEST(LrpStructure, BlocksAndTables) {
  const Exemplar exemplar = test_exemplar({40, 50}, 3);
  EXPECT_LE(measure(lrp_structure_deviation, with({.ratio = 0.3}), exemplar).value(), 1. / 256);
  const LrpOptions all = with({.ratio = 1, .reduced = false});
  EXPECT_EQ(measure(lrp_block_side, all, exemplar), 32);
  EXPECT_EQ(measure(lrp_table_entries, all, exemplar), 514) << "the half plane of 32 x 32";
}

TEST(LrpStructure, TurbulenceIsContinuousInTheRightOrderAlone) {
  const Exemplar exemplar = test_exemplar({80, 70}, 1);
  const LrpOptions options = with({.ratio = 0.2, .turbulence = 3, .placement = true});
  EXPECT_LT(measure(lrp_distortion_jump, options, exemplar).value(), 0.02);
  // Two independent displacements differ by √2 σ on each axis.
  EXPECT_NEAR(measure(lrp_swapped_distortion_jump, options, exemplar).value(), 1.41, 0.25);
  EXPECT_LT(measure(lrp_jump, options, exemplar).value(), 0.05);
  EXPECT_GT(measure(lrp_radial_change, options, exemplar).value(), 0);
  EXPECT_EQ(measure(lrp_radial_change, with({.ratio = 0.2}), exemplar), 0);
  EXPECT_GT(measure(lrp_fixed_time_ratio, options, exemplar).value(), 0);
  EXPECT_GT(measure(lrp_placement_time_ratio, options, exemplar).value(), 0);
}

TEST(LrpStructure, IsNullWhereThereIsNone) {
  const Exemplar exemplar = test_exemplar({40, 36}, 1);
  for (const LrpMetric metric :
       {lrp_copy_error, lrp_printed_copy_error, lrp_structure_deviation, lrp_block_side, lrp_table_entries,
        lrp_distortion_jump, lrp_swapped_distortion_jump, lrp_fixed_time_ratio, lrp_placement_time_ratio,
        lrp_radial_change, lrp_structure_filter_error, lrp_structure_clamp_error, lrp_structure_aliasing_error}) {
    EXPECT_FALSE(measure(metric, {}, exemplar).has_value());
  }
  const auto model = fit_adsn(exemplar, {});
  EXPECT_FALSE(lrp_jump(*model, make_target(exemplar), {}).has_value());
  EXPECT_FALSE(lrp_welch_ratio(*model, make_target(exemplar), {}).has_value());
}

TEST(LrpEstimates, AveragedPeriodogramsAndClampedFrequenciesAreBetter) {
  const Exemplar exemplar = test_exemplar({80, 70}, 1);
  const LrpOptions options = with({.ratio = 0.3});
  EXPECT_LT(measure(lrp_welch_ratio, {}, exemplar).value(), 1);
  EXPECT_LT(measure(lrp_series_error, {}, exemplar).value(), 0.01);
  EXPECT_LT(measure(lrp_noise_filter_error, options, exemplar).value(),
            measure(lrp_noise_aliasing_error, options, exemplar).value());
  EXPECT_LE(measure(lrp_structure_filter_error, options, exemplar).value(),
            measure(lrp_structure_aliasing_error, options, exemplar).value());
}

/// Gaussian noise needs no structure; spots on a ground are all structure.
TEST(StructureSuggestion, TellsNoiseFromSpots) {
  Exemplar noise{"noise", Image({96, 96}, 1), ""};
  for (int y = 0; y < 96; ++y) {
    fill_normal(Stream(Seed{3}), static_cast<std::uint64_t>(y), 0, noise.pixels.row(0, y));
  }
  const StructureSuggestion of_noise = suggest_structure(noise, {}, Seed{1});
  EXPECT_TRUE(of_noise.gaussian);
  EXPECT_EQ(of_noise.ratio, 0);
  Exemplar spots = noise;
  for (int y = 0; y < 96; ++y) {
    for (float& v : spots.pixels.row(0, y)) v = v > 2 ? 1.0F : 0.0F;
  }
  const StructureSuggestion of_spots = suggest_structure(spots, {}, Seed{1});
  EXPECT_FALSE(of_spots.gaussian);
  EXPECT_GT(of_spots.ratio, 0);
  EXPECT_NEAR(of_spots.survival.front(), 0, 1e-9);
  EXPECT_NEAR(of_spots.survival.back(), 1, 1e-6);
  EXPECT_NEAR(measure(lrp_structure_survival, with({.ratio = 1}), spots).value(), 1, 1e-6);
  EXPECT_EQ(measure(lrp_suggested_structure, {}, spots), of_spots.ratio);
}

/// Neighboring patches share six of seven columns, so that even in other white noise their nearest ones often are
/// neighbors: that chance is what the floor is for.
TEST(VerbatimCopy, IsOneOfACopyAndAChanceOfNoise) {
  const Exemplar exemplar{"white", white_noise({60, 50}, 3, 7), ""};
  const Target target = make_target(exemplar);
  const Domain domain{.size = {40, 30}};
  const auto metric = verbatim_copy(target, domain, Seed{1});
  EXPECT_EQ(metric->statistic(crop(exemplar.pixels, 11, 7, {40, 30}), domain).front(), 1);
  EXPECT_LT(metric->statistic(white_noise({40, 30}, 3, 4), domain).front(), 0.5);
  EXPECT_THROW(verbatim_copy(target, {.size = {7, 30}}, Seed{1}), std::invalid_argument);
}

TEST(AutocorrelationPeakError, IsZeroOfThePatternItself) {
  // A wave of a period of 10 pixels: its autocorrelation is 1 there, and 0 of white noise.
  Exemplar wave{"wave", Image({60, 40}, 1), ""};
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) wave.pixels.at(0, x, y) = static_cast<float>(std::cos(2 * M_PI * (x / 10. + y / 8.)));
  }
  const Target target = make_target(wave);
  const Domain domain{.size = {60, 40}};
  const auto metric = autocorrelation_peak_error(target, domain, Seed{1});
  const auto value = [&](const Image& sample) {
    const std::vector<float> statistic = metric->statistic(sample, domain);
    return metric->value(std::vector<double>(statistic.begin(), statistic.end()));
  };
  EXPECT_LT(value(wave.pixels), 0.01);
  EXPECT_GT(value(white_noise({60, 40}, 1, 4)), 0.9);
}

TEST(LrpDiagrams, AreThereOrTellWhatIsMissing) {
  const Exemplar exemplar = test_exemplar({40, 36}, 3);
  const auto model = make_lrp(analyze_lrp(exemplar, with({.ratio = 0.2}), Seed{1}));
  const Domain domain{.size = {20, 10}};
  for (const LrpDiagram diagram :
       {LrpDiagram::power, LrpDiagram::strata, LrpDiagram::eroded, LrpDiagram::parts, LrpDiagram::windows,
        LrpDiagram::variance, LrpDiagram::structure, LrpDiagram::reduced, LrpDiagram::residual}) {
    const Image picture = lrp_diagram(*model, diagram, domain);
    EXPECT_EQ(picture.extent(), (Extent{32, 32}));
    EXPECT_EQ(picture.channels(), 3);
  }
  // The layers add up to the sample without its structure.
  const Image layer = lrp_diagram(*model, LrpDiagram::layer_1, domain);
  EXPECT_EQ(layer.extent(), domain.size);
  const Image power = lrp_diagram(*model, LrpDiagram::power, domain);
  EXPECT_EQ(power.at(0, 16 + 3, 16 + 2), power.at(0, 16 - 3, 16 - 2)) << "symmetric around the middle";
  const auto plain = make_lrp(analyze_lrp(exemplar, {}, Seed{1}));
  EXPECT_THROW(lrp_diagram(*plain, LrpDiagram::structure, domain), std::invalid_argument);
  EXPECT_THROW(lrp_diagram(*fit_adsn(exemplar, {}), LrpDiagram::power, domain), std::invalid_argument);
}

}  // namespace
}  // namespace textonbench
