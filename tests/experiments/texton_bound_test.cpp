// Optimal textons come close to the proven bound on every exemplar that a default run knows.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "experiments/child_process.h"
#include "experiments/exemplars.h"
#include "methods/base/image.h"
#include "methods/exemplar_spot.h"
#include "methods/spot/optimal_texton.h"
#include "methods/spot/support.h"

namespace textonbench::texton_bound_test {

const ExemplarCatalog& default_catalog() {
  static const ExemplarCatalog catalog(TEXTONBENCH_SOURCE_DIR);
  return catalog;
}

class TextonBoundGap : public testing::TestWithParam<std::string> {};

/// Support 31 x 31, the default four textons and evaluations, the top left 256 x 256 pixels of larger exemplars.
TEST_P(TextonBoundGap, IsBelowTwoThousandthsOfTheVariance) {
  if (!enforces_memory_limits()) GTEST_SKIP() << "takes minutes in a build with a sanitizer";
  const ExemplarInfo& info = default_catalog().look_up(GetParam());
  if (!info.available) GTEST_SKIP() << GetParam() << " is not here: " << info.how_to_get;
  Exemplar exemplar = load_exemplar(info);
  const Extent size = exemplar.pixels.extent();
  exemplar.pixels = crop(exemplar.pixels, 0, 0, {std::min(size.width, 256), std::min(size.height, 256)});
  const GaussianModel model = fit_spot(exemplar, SpotSource::periodic_component);
  const Image mask = support_image(square_support(31));
  const double rme = fit_optimal_texton(model, mask, {}, Seed{1}).rme;
  const double bound = bound_texton_error(model, mask, {}, Seed{1}).rme;
  EXPECT_GE(rme, bound);
  EXPECT_LT(rme * rme - bound * bound, 2e-3);
  RecordProperty("gap", std::to_string(rme * rme - bound * bound));
}

INSTANTIATE_TEST_SUITE_P(DefaultExemplars, TextonBoundGap, testing::ValuesIn(default_catalog().tagged("default")),
                         [](const auto& instance) { return instance.param; });

}  // namespace textonbench::texton_bound_test
