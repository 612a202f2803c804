// What Gabor noise takes, counted by hand.
#include "experiments/metrics/gabor_metrics.h"

#include <gtest/gtest.h>

#include "methods/method.h"
#include "methods/sparse/gabor.h"
#include "tests/texture.h"

namespace textonbench {
namespace {

TEST(GaborMetrics, CountKernelsWindowsAndImpacts) {
  const Exemplar exemplar = test_exemplar({32, 32}, 3);
  const Target target = make_target(exemplar);
  const Domain domain{.size = {32, 32}};
  const MethodEntry& entry = find_method("gabor");
  const auto model =
      entry.analyze({exemplar}, Params(entry.params, {{"directions", std::int64_t{5}}, {"mni", 7.0}}), Seed{1});
  EXPECT_EQ(gabor_kernels(*model, target, domain), 5) << "colors share frequencies";
  EXPECT_EQ(gabor_windows(*model, target, domain), 1);
  EXPECT_NEAR(gabor_impacts(*model, target, domain).value(), 7, 0.01) << "sides of cells are rounded";
  const MethodEntry& other = find_method("adsn");
  const auto spectral = other.analyze({exemplar}, Params(other.params, {}), Seed{1});
  for (const MetricEntry& metric : gabor_metrics()) {
    EXPECT_EQ(metric.of_model(*spectral, target, domain), std::nullopt) << metric.name;
  }
}

TEST(GaborMetrics, OfAMixtureCountAWindowAKernel) {
  const Exemplar exemplar = test_exemplar({40, 40}, 3);
  const Target target = make_target(exemplar);
  const MethodEntry& entry = find_method("gabor_by_example");
  const auto model = entry.analyze(
      {exemplar}, Params(entry.params, {{"fitter", std::string("mixture")}, {"kernels", std::int64_t{4}}}), Seed{1});
  const Domain domain{.size = {40, 40}};
  EXPECT_EQ(gabor_kernels(*model, target, domain), gabor_windows(*model, target, domain));
  EXPECT_LE(gabor_kernels(*model, target, domain).value(), 4);
  EXPECT_NEAR(gabor_impacts(*model, target, domain).value(), 40, 0.5);
}

}  // namespace
}  // namespace textonbench
