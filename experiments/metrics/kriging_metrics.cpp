#include "experiments/metrics/kriging_metrics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

#include "methods/conditional/inpainting.h"

namespace textonbench {
namespace {

constexpr std::size_t most_unknowns = 5000;

const Inpainting* inpainting(const Model& model) { return dynamic_cast<const Inpainting*>(&model); }

template <class Value>
std::optional<double> of_summary(const Model& model, const Value& value) {
  const Inpainting* law = inpainting(model);
  return law == nullptr ? std::nullopt : std::optional(static_cast<double>(value(law->kriging_solution().summary)));
}

Eigen::VectorXd to_vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

Eigen::MatrixXd dense_matrix(const KrigingOperator& op) {
  Eigen::MatrixXd matrix(op.unknowns(), op.unknowns());
  std::vector<int> all(static_cast<std::size_t>(op.points()));
  std::iota(all.begin(), all.end(), 0);
  op.fill_matrix(all, op.covariance().table(op.box().size), matrix.data());
  return matrix;
}

/// The largest eigenvalue of a symmetric positive operator, as the Rayleigh quotient after power iterations.
template <class Apply>
double largest_eigenvalue(Eigen::Index size, const Apply& apply) {
  constexpr int iterations = 200;
  Eigen::VectorXd x(size);
  RandomSequence numbers(Stream(Seed{1}).child("power iteration"));
  for (double& value : x) value = numbers.normal();
  double quotient = 0;
  for (int i = 0; i < iterations; ++i) {
    x.normalize();
    const Eigen::VectorXd y = apply(x);
    quotient = x.dot(y);
    x = y;
  }
  return quotient;
}

}  // namespace

std::optional<double> kriging_residual(const Model& model, const Target&, const Domain&) {
  return of_summary(model, [](const SolveSummary& s) { return s.residual; });
}

std::optional<double> kriging_iterations(const Model& model, const Target&, const Domain&) {
  return of_summary(model, [](const SolveSummary& s) { return s.iterations; });
}

std::optional<double> kriging_unknowns(const Model& model, const Target&, const Domain&) {
  const Inpainting* law = inpainting(model);
  if (law == nullptr) return std::nullopt;
  return static_cast<double>(law->kriging_operator().unknowns());
}

std::optional<double> kriging_setup_seconds(const Model& model, const Target&, const Domain&) {
  const Inpainting* law = inpainting(model);
  return law == nullptr ? std::nullopt : std::optional(law->system().setup_seconds());
}

std::optional<double> kriging_solve_seconds(const Model& model, const Target&, const Domain&) {
  return of_summary(model, [](const SolveSummary& s) { return s.solve_seconds; });
}

std::optional<double> kriging_iteration_seconds(const Model& model, const Target&, const Domain&) {
  const Inpainting* law = inpainting(model);
  if (law == nullptr || law->system().solver() == KrigingSolver::dense) return std::nullopt;
  using Clock = std::chrono::steady_clock;
  std::vector<double> seconds;
  std::optional<Clock::time_point> last;
  law->system().solve(law->right_side(), [&](int, std::span<const double>, double) {
    const Clock::time_point now = Clock::now();
    if (last) seconds.push_back(std::chrono::duration<double>(now - *last).count());
    last = now;
  });
  if (seconds.empty()) return std::nullopt;
  const auto middle = seconds.begin() + std::ssize(seconds) / 2;
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

std::optional<double> kriging_bytes(const Model& model, const Target&, const Domain&) {
  const Inpainting* law = inpainting(model);
  return law == nullptr ? std::nullopt : std::optional(static_cast<double>(law->system().bytes()));
}

std::optional<double> kriging_error(const Model& model, const Target&, const Domain&) {
  const Inpainting* law = inpainting(model);
  if (law == nullptr || law->kriging_operator().unknowns() > most_unknowns) return std::nullopt;
  const KrigingOperator& op = law->kriging_operator();
  const std::vector<double> right_side = law->right_side();
  const KrigingSystem dense(op, {.solver = KrigingSolver::dense});
  const Eigen::VectorXd exact = to_vector(op.extend(dense.solve(right_side).k));
  const Eigen::VectorXd found = to_vector(op.extend(law->kriging_solution().k));
  const double square = (found - exact).squaredNorm() / static_cast<double>(exact.size());
  return std::sqrt(square / mean_variance(op.field()));
}

std::optional<double> kriging_condition_number(const Model& model, const Target&, const Domain&) {
  const Inpainting* law = inpainting(model);
  if (law == nullptr || law->kriging_operator().unknowns() > most_unknowns) return std::nullopt;
  const Eigen::MatrixXd matrix = dense_matrix(law->kriging_operator());
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const double largest =
      largest_eigenvalue(matrix.rows(), [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return matrix * x; });
  const double inverse_least =
      largest_eigenvalue(matrix.rows(), [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return factor.solve(x); });
  return largest * inverse_least;
}

}  // namespace textonbench
