// Counts of impacts and cells, and mixtures: at the value of theory where it holds.
#include "experiments/metrics/plane_impacts.h"

#include <gtest/gtest.h>

#include "experiments/metrics/mixing_identities.h"
#include "methods/spot/spline_noise.h"
#include "tests/metrics/metric_fixture.h"
#include "tests/texton.h"

namespace textonbench::plane_impacts_test {

class PlaneImpacts : public testing::Test {
 protected:
  double of(std::optional<double> (*metric)(const Model&, const Target&, const Domain&)) const {
    return metric(*model_, target_, domain_).value();
  }

  const Exemplar exemplar_ = smooth_exemplar({128, 128}, 3);
  const Target target_ = make_target(exemplar_);
  const Domain domain_{.size = {64, 64}};
  const std::unique_ptr<Model> model_ =
      make_spline_noise({.coefficients = test_texton({9, 9}, 1, 1), .order = 1, .support_area = 100}, {.cell = 1});
};

// Of 4096 Poisson numbers of mean 120 the mean has an error of 0.17, of those of mean 30 one of 0.09: five of each.
TEST_F(PlaneImpacts, CellsOfTheSupport) {
  EXPECT_EQ(of(cells_visited), 4);
  EXPECT_NEAR(of(impacts_drawn_ratio), 4, 5 * 0.17 / 30);
  EXPECT_NEAR(of(fetches_per_pixel), 30, 5 * 0.09);
}

// A rounded Gaussian number of mean m has the variance m + 1/12 and is negative with the probability Φ(−(m + 1/2)/√m).
TEST_F(PlaneImpacts, GaussianCounts) {
  constexpr double mean = 30 * 0.625 * 0.625, draws = 1 << 22;
  EXPECT_NEAR(of(gaussian_count_mean), 1, 5 / std::sqrt(mean * draws) + 1e-4);
  EXPECT_NEAR(of(gaussian_count_variance), 1 + 1 / (12 * mean), 5 * std::sqrt(2 / draws) + 2e-4);
  const double negative = std::erfc((mean + 0.5) / std::sqrt(2 * mean)) / 2;
  EXPECT_NEAR(of(negative_count_part), negative, 5 * std::sqrt(negative / draws));
}

// A deviation exceeds 1 with probability 1 %; keys are fixed by the exemplar's name. Wang's hash and xorshift leave a
// correlation near 0.016 between the first words of cells above each other, which reach this only through the counts.
TEST_F(PlaneImpacts, CongruentialCellsAreCorrelated) {
  EXPECT_GT(of(congruential_cell_correlation), 100);
  EXPECT_LT(of(hashed_cell_correlation), 3);
  EXPECT_LT(of(counter_cell_correlation), 1);
}

TEST_F(PlaneImpacts, Mixtures) {
  EXPECT_LT(of(barycenter_distance_error), 1e-3);
  EXPECT_LT(of(barycenter_end_error), 1e-5);
  EXPECT_GT(of(neighbor_texton_correlation), 0.8);
  EXPECT_LT(std::abs(of(unlike_start_correlation)), 0.3);
  // Squared differences of neighbors that hardly correlate over 32 samples, 20 borders and 64 rows, three channels.
  EXPECT_NEAR(of(strip_border_ratio), 1, 0.1);
}

TEST_F(PlaneImpacts, NothingForExemplarsTooSmallToCrop) {
  const Exemplar small_exemplar = smooth_exemplar({12, 12}, 3);
  const Target small = make_target(small_exemplar);
  for (const auto metric : {barycenter_distance_error, barycenter_end_error, neighbor_texton_correlation,
                            unlike_start_correlation, strip_border_ratio}) {
    EXPECT_FALSE(metric(*model_, small, domain_));
  }
  const MethodEntry& entry = find_method("adsn");
  const auto adsn = entry.analyze({exemplar_}, Params(entry.params, {}), Seed{1});
  for (const auto metric : {cells_visited, impacts_drawn_ratio, fetches_per_pixel}) {
    EXPECT_FALSE(metric(*adsn, target_, domain_));
  }
}

}  // namespace textonbench::plane_impacts_test
