#include "experiments/metrics/exemplar_patches.h"

#include <gtest/gtest.h>

#include "tests/metrics/metric_fixture.h"

namespace textonbench::exemplar_patches_test {

double distance_of(const Exemplar& exemplar) {
  const MethodEntry& entry = find_method("adsn");
  const auto model = entry.analyze({exemplar}, Params(entry.params, {}), Seed{1});
  return exemplar_patch_distance(*model, make_target(exemplar), {}).value();
}

TEST(ExemplarPatches, TellAGaussianExemplarFromSparseSpots) {
  const Exemplar gaussian = smooth_exemplar({128, 128}, 3);
  Exemplar spots = gaussian;
  spots.pixels = mapped(spots.pixels, [](double v, int c) { return v > 0.75 - 0.15 * c ? 1.0 : 0.0; });
  EXPECT_LT(distance_of(gaussian), 0.02);
  EXPECT_GT(distance_of(spots), 5 * distance_of(gaussian));
}

}  // namespace textonbench::exemplar_patches_test
