// Held to dense algebra, and to properties that hold whatever the numbers.
#include "experiments/metrics/kriging_metrics.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numeric>

#include "experiments/metrics/conditional_law.h"
#include "methods/base/masks.h"
#include "methods/conditional/inpainting.h"
#include "methods/spectral/adsn.h"
#include "tests/sanitizer.h"
#include "tests/texture.h"

namespace textonbench::kriging_metrics_test {

class KrigingMetrics : public testing::Test {
 protected:
  Inpainting make(const std::string& mask, const InpaintingOptions& options = {}, double percent = 10) const {
    return {exemplar_.pixels, make_mask(mask, percent, exemplar_.pixels.extent()), nullptr, options};
  }

  Exemplar exemplar_ = test_exemplar({60, 50}, 3);
  Target target_ = make_target(exemplar_);
  Domain domain_{.size = {60, 50}};
};

TEST_F(KrigingMetrics, AreNullForOtherModels) {
  const auto adsn = fit_adsn(exemplar_, {});
  for (const auto metric :
       {kriging_residual, kriging_iterations, kriging_unknowns, kriging_setup_seconds, kriging_solve_seconds,
        kriging_iteration_seconds, kriging_bytes, kriging_error, kriging_condition_number, conditional_mean_deviation,
        conditional_covariance_deviation, kriging_innovation_correlation, kriging_border_distance,
        kriging_variance_ratio, hole_covariance_ratio, estimate_bias}) {
    EXPECT_EQ(metric(*adsn, target_, domain_), std::nullopt);
  }
}

TEST_F(KrigingMetrics, ConditionNumberIsTheRatioOfEigenvalues) {
  const Inpainting model = make("rect:20,20,9,7", {.border = 2});
  const KrigingOperator& op = model.kriging_operator();
  Eigen::MatrixXd matrix(op.unknowns(), op.unknowns());
  std::vector<int> all(static_cast<std::size_t>(op.points()));
  std::iota(all.begin(), all.end(), 0);
  op.fill_matrix(all, op.covariance().table(op.box().size), matrix.data());
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
  const double expected = values.maxCoeff() / values.minCoeff();
  EXPECT_NEAR(kriging_condition_number(model, target_, domain_).value(), expected, 0.01 * expected);
}

TEST_F(KrigingMetrics, TellHowTheSystemWasSolved) {
  const Inpainting few =
      make("rect:20,20,9,7", {.solve = {.solver = KrigingSolver::cg, .tolerance = 0, .iterations = 5}});
  EXPECT_EQ(kriging_iterations(few, target_, domain_), 5.0);
  EXPECT_EQ(kriging_unknowns(few, target_, domain_), static_cast<double>(few.kriging_operator().unknowns()));
  EXPECT_GT(kriging_residual(few, target_, domain_).value(), 1e-3);
  EXPECT_GT(kriging_error(few, target_, domain_).value(), 1e-3);
  EXPECT_GT(kriging_iteration_seconds(few, target_, domain_).value(), 0);
  EXPECT_EQ(kriging_bytes(few, target_, domain_), 0.0);
  const Inpainting dense = make("rect:20,20,9,7", {.solve = {.solver = KrigingSolver::dense}});
  EXPECT_EQ(kriging_iterations(dense, target_, domain_), 0.0);
  EXPECT_EQ(kriging_error(dense, target_, domain_), 0.0);
  EXPECT_LT(kriging_residual(dense, target_, domain_).value(), 1e-10);
  EXPECT_EQ(kriging_iteration_seconds(dense, target_, domain_), std::nullopt);
  EXPECT_GT(kriging_setup_seconds(dense, target_, domain_).value(), 0);
  EXPECT_GE(kriging_solve_seconds(dense, target_, domain_).value(), 0);
}

/// What is known more can only lower the variance, and the border itself is no distance away.
TEST_F(KrigingMetrics, WiderBordersTellMore) {
  const double narrow = kriging_variance_ratio(make("rect:20,20,5,5", {.border = 1}), target_, domain_).value();
  const double wide = kriging_variance_ratio(make("rect:20,20,5,5", {.border = 4}), target_, domain_).value();
  EXPECT_GE(narrow, wide);
  EXPECT_GE(wide, 1);
  EXPECT_NEAR(kriging_variance_ratio(make("rect:20,20,5,5", {.border = 10}), target_, domain_).value(), 1, 1e-9);
  EXPECT_NEAR(kriging_border_distance(make("rect:20,20,5,5", {.border = 20}), target_, domain_).value(), 0, 1e-4);
  EXPECT_GT(kriging_border_distance(make("rect:20,20,5,5", {.border = 1}), target_, domain_).value(), 1e-3);
}

/// Deviations are standard normal numbers: outside ±5 with probability 6e-7. Of 3600 correlations none exceeds 6 with
/// probability 1 − 7e-6.
TEST_F(KrigingMetrics, SamplesHaveTheConditionalLaw) {
  if (sanitized) GTEST_SKIP() << "statistics of 2000 samples are left to the other builds";
  const Inpainting model = make("square");
  EXPECT_LT(std::fabs(conditional_mean_deviation(model, target_, domain_).value()), 5);
  EXPECT_LT(std::fabs(conditional_covariance_deviation(model, target_, domain_).value()), 5);
  EXPECT_LT(kriging_innovation_correlation(model, target_, domain_).value(), 6);
}

/// A product of two pixels survives with the square of the probability of one and is normalized by it.
TEST_F(KrigingMetrics, MissingPixelsThinTheCovariance) {
  const InpaintingOptions quick{.border = 1, .nugget = 0.1, .solve = {.solver = KrigingSolver::cg, .iterations = 1}};
  const double scattered = estimate_bias(make("pixels", quick, 75), target_, domain_).value();
  EXPECT_GT(scattered, 0.3);
  EXPECT_LT(scattered, 0.85);
  EXPECT_LT(estimate_bias(make("rect:20,20,5,5"), target_, domain_).value(), 0.2);
}

TEST_F(KrigingMetrics, CovarianceAcrossTheEdgeIsCompared) {
  const double ratio = hole_covariance_ratio(make("rect:20,20,12,12"), target_, domain_).value();
  EXPECT_GT(ratio, 0);
  EXPECT_LT(ratio, 2);
}

}  // namespace textonbench::kriging_metrics_test
