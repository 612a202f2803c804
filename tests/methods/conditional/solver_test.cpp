// Every solver against the dense solution, and against what was published.
#include "methods/conditional/solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "methods/base/image_io.h"
#include "methods/conditional/inpainting.h"
#include "tests/methods/conditional/dense_kriging.h"
#include "tests/texture.h"

namespace textonbench::solver_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

KrigingOperator small_problem(bool periodic = false, double nugget = 0) {
  const Mask missing = rectangle_mask({40, 32}, {12, 10, {14, 11}});
  GaussianField field = estimate_field(test_texture({40, 32}, 3), missing);
  field.periodic = periodic;
  field.nugget_variance = nugget * mean_variance(field);
  return {field, difference(dilate(missing, 2), missing), missing};
}

std::vector<double> some_right_side(const KrigingOperator& op) { return op.simulate(Seed{3}).conditioning; }

class Solver : public testing::TestWithParam<std::string> {};

/// The normal equations square the condition number, and solve a better conditioned problem here.
TEST_P(Solver, FindsTheDenseSolution) {
  for (const bool periodic : {false, true}) {
    const KrigingOperator op = small_problem(periodic, GetParam() == "normal" ? 1e-2 : 0);
    const std::vector<double> b = some_right_side(op);
    const Eigen::MatrixXd dense =
        plain_matrix(op.field(), {40, 32}, op.conditioning_pixels(), op.conditioning_pixels());
    const Eigen::VectorXd exact = dense.llt().solve(to_vector(b));
    const KrigingSolver solver = kriging_solver(GetParam());
    const KrigingSystem system(op, {.solver = solver, .tolerance = 1e-11, .iterations = 5000});
    int calls = 0;
    const KrigingSystem::Solution solution =
        system.solve(b, [&](int iteration, std::span<const double> k, double residual) {
          EXPECT_EQ(iteration, ++calls);
          EXPECT_EQ(k.size(), op.unknowns());
          EXPECT_GE(residual, 0);
        });
    EXPECT_EQ(solution.summary.solver, solver);
    EXPECT_EQ(solution.summary.iterations, calls);
    EXPECT_TRUE(solution.summary.converged()) << solution.summary.reason;
    EXPECT_LT((to_vector(solution.k) - exact).norm(), 1e-6 * exact.norm());
    EXPECT_NEAR(solution.summary.residual, (to_vector(b) - dense * to_vector(solution.k)).norm() / to_vector(b).norm(),
                1e-12);
  }
}

TEST_P(Solver, SameBitsWhateverTheThreads) {
  const KrigingOperator op = small_problem();
  const std::vector<double> b = some_right_side(op);
  const auto solution = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return KrigingSystem(op, {.solver = kriging_solver(GetParam()), .iterations = 40}).solve(b).k;
  };
  EXPECT_EQ(solution(1), solution(2));
}

TEST_P(Solver, ZeroHasTheSolutionZero) {
  const KrigingOperator op = small_problem();
  const std::vector<double> zero(op.unknowns());
  const auto solution = KrigingSystem(op, {.solver = kriging_solver(GetParam())}).solve(zero);
  EXPECT_EQ(solution.k, zero);
  EXPECT_TRUE(solution.summary.converged());
}

INSTANTIATE_TEST_SUITE_P(All, Solver, testing::Values("dense", "cg", "schwarz", "circulant", "normal"),
                         [](const auto& one) { return one.param; });

TEST(SolverChoice, DenseForFewUnknownsAndSchwarzForMany) {
  const KrigingOperator few = small_problem();
  ASSERT_LE(few.unknowns(), automatic_dense_unknowns);
  EXPECT_EQ(KrigingSystem(few, {}).solver(), KrigingSolver::dense);
  const Mask missing = rectangle_mask({90, 80}, {10, 10, {64, 60}});
  const KrigingOperator many(estimate_field(test_texture({90, 80}, 3), missing),
                             difference(dilate(missing, 3), missing), missing);
  ASSERT_GT(many.unknowns(), automatic_dense_unknowns);
  EXPECT_EQ(KrigingSystem(many, {}).solver(), KrigingSolver::schwarz);
}

TEST(SolverErrors, ThatItDidNotConvergeIsTold) {
  const KrigingOperator op = small_problem();
  const auto solution = KrigingSystem(op, {.solver = KrigingSolver::cg, .iterations = 3}).solve(some_right_side(op));
  EXPECT_EQ(solution.summary.reason, "iterations");
  EXPECT_EQ(solution.summary.iterations, 3);
  EXPECT_FALSE(solution.summary.converged());
  EXPECT_GT(solution.summary.residual, 1e-3);
}

/// Three channels driven by one noise on 12 x 10 pixels: the rank is 119, the unknowns are 3 (12 x 10 − 4 x 4) = 312.
TEST(SolverErrors, SingularSystemsNameTheNuggetThatHelps) {
  const Extent size{12, 10};
  const Mask missing = rectangle_mask(size, {4, 3, {4, 4}});
  GaussianField field = estimate_field(test_texture(size, 3), missing);
  field.periodic = true;
  const Mask all = difference(Mask(size, true), missing);
  const KrigingOperator singular(field, all, missing);
  for (const char* solver : {"dense", "cg", "schwarz", "normal"}) {
    EXPECT_THAT([&] { KrigingSystem(singular, {.solver = kriging_solver(solver)}); },
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr("312 conditioning values"), HasSubstr("rank 119"), HasSubstr("nugget=0.0001"))));
  }
  field.nugget_variance = 1e-4 * mean_variance(field);
  const KrigingOperator regular(field, all, missing);
  const auto solution = KrigingSystem(regular, {}).solve(some_right_side(regular));
  EXPECT_LT(solution.summary.residual, 1e-9);
}

/// Channels that are copies of each other: singular on the plane too, which only the factor can tell.
TEST(SolverErrors, SingularFactorsNameTheNuggetThatHelps) {
  const Image gray = test_texture({30, 30}, 1);
  Image copies({30, 30}, 2);
  for (int y = 0; y < 30; ++y) {
    for (int c = 0; c < 2; ++c) std::ranges::copy(gray.row(0, y), copies.row(c, y).begin());
  }
  const Mask missing = rectangle_mask({30, 30}, {10, 10, {8, 8}});
  const KrigingOperator op(estimate_field(copies, missing), difference(dilate(missing, 3), missing), missing);
  for (const char* solver : {"dense", "schwarz"}) {
    EXPECT_THAT([&] { KrigingSystem(op, {.solver = kriging_solver(solver)}); },
                ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("singular"), HasSubstr("nugget=0.0001"))));
  }
}

TEST(SolverErrors, TooManyUnknownsForADenseMatrix) {
  const Extent size{300, 300};
  const Mask missing = rectangle_mask(size, {20, 20, {260, 260}});
  const KrigingOperator op(estimate_field(test_texture(size, 3), missing), difference(dilate(missing, 4), missing),
                           missing);
  EXPECT_THAT([&] { KrigingSystem(op, {.solver = KrigingSolver::dense}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("expected at most 10000; solver schwarz")));
  EXPECT_THROW(kriging_solver("lu"), std::invalid_argument);
}

// What was published: holes of 100 x 100 in two textures of 256 x 256, 3708 unknowns.

Inpainting published_problem(const std::string& name, const SolveOptions& options) {
  const Image u = read_image(*folder_from("TEXTONBENCH_DATA") / (name + ".png")).image;
  return {u, rectangle_mask(u.extent(), {78, 78, {100, 100}}), nullptr, {.border = 3, .solve = options}};
}

class PublishedSolver : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!folder_from("TEXTONBENCH_DATA") || !folder_from("TEXTONBENCH_REFERENCE")) {
      GTEST_SKIP() << "TEXTONBENCH_DATA and TEXTONBENCH_REFERENCE are not set";
    }
  }
};

/// True residuals ‖φ − Γ k‖ / ‖φ‖ at some iterations.
std::map<int, double> true_residuals(const Inpainting& model, const std::vector<int>& iterations) {
  const KrigingOperator& op = model.kriging_operator();
  const Eigen::VectorXd b = to_vector(model.right_side());
  std::map<int, double> result;
  KrigingOperator::Workspace workspace;
  std::vector<double> product(op.unknowns());
  model.kriging_sample([&](int iteration, std::span<const double> k, double) {
    if (std::ranges::find(iterations, iteration) == iterations.end()) return;
    op.apply(k, product, workspace);
    result[iteration] = (b - to_vector(product)).norm() / b.norm();
  });
  return result;
}

/// Later residuals of plain conjugate gradient are decided by rounding: at 100 iterations the two published tables for
/// blue_fabric2_crop, of the same data in the same precision, have 0.1109 and 0.1200, and pixels rounded to float32
/// move those for wood_256 by a factor of three. Those of the normal equations, which converge slowly, are not.
TEST_P(PublishedSolver, ResidualsAreThePublishedOnes) {
  const std::filesystem::path file = *folder_from("TEXTONBENCH_REFERENCE") / ("inpainting_cg_" + GetParam() + ".json");
  std::ifstream in(file);
  const nlohmann::json published = nlohmann::json::parse(in);
  const auto expect_published = [&](const char* table, KrigingSolver solver, const std::vector<int>& iterations) {
    const Inpainting model =
        published_problem(GetParam(), {.solver = solver, .tolerance = 0, .iterations = iterations.back()});
    const std::map<int, double> residuals = true_residuals(model, iterations);
    int compared = 0;
    for (const auto& row : published.at(table)) {
      const auto found = residuals.find(row.at("it").get<int>());
      if (found == residuals.end()) continue;
      const double expected = row.at("true_rel_Ax_y").get<double>();
      EXPECT_NEAR(found->second, expected, 0.05 * expected) << table << " " << found->first;
      ++compared;
    }
    EXPECT_EQ(compared, std::ssize(iterations));
  };
  expect_published("cg_normal", KrigingSolver::normal, {1, 10, 20, 50, 100});
  expect_published("cg_direct", KrigingSolver::cg, {1, 10});
}

TEST_P(PublishedSolver, SchwarzNeedsFewIterations) {
  const Inpainting model = published_problem(GetParam(), {.solver = KrigingSolver::schwarz});
  const SolveSummary summary = model.kriging_sample().summary;
  EXPECT_EQ(summary.unknowns, 3708U);
  EXPECT_TRUE(summary.converged());
  EXPECT_LE(summary.residual, 1.05e-6);
  EXPECT_LE(summary.iterations, 30);
}

INSTANTIATE_TEST_SUITE_P(Textures, PublishedSolver, testing::Values("blue_fabric2_crop", "wood_256"),
                         [](const auto& one) { return one.param; });

}  // namespace textonbench::solver_test
