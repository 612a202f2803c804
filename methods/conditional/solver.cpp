#include "methods/conditional/solver.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

namespace textonbench {
namespace {

using Clock = std::chrono::steady_clock;
using Vector = Eigen::VectorXd;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr std::array<std::pair<KrigingSolver, std::string_view>, 6> solver_names{{
    {KrigingSolver::automatic, "auto"},
    {KrigingSolver::dense, "dense"},
    {KrigingSolver::cg, "cg"},
    {KrigingSolver::schwarz, "schwarz"},
    {KrigingSolver::circulant, "circulant"},
    {KrigingSolver::normal, "normal"},
}};

std::span<const double> view(const Vector& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
std::span<double> view(Vector& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

/// A table of all lags of the box, or nothing when it would be larger than the matrices that `dense` is meant for.
bool table_fits(const KrigingOperator& op) {
  constexpr double most = 256 << 20;
  return 4.0 * static_cast<double>(op.box().size.area()) * op.channels() * op.channels() * sizeof(double) <= most;
}

KrigingSolver chosen(KrigingSolver solver, const KrigingOperator& op) {
  if (solver != KrigingSolver::automatic) return solver;
  return op.unknowns() <= automatic_dense_unknowns && table_fits(op) ? KrigingSolver::dense : KrigingSolver::schwarz;
}

[[noreturn]] void fail_not_positive(std::size_t unknowns) {
  throw std::invalid_argument(fmt::format(
      "the covariance of the {} conditioning values is singular to working precision; {}", unknowns, nugget_advice()));
}

/// One noise drives all channels, so the law on a torus of |Ω| pixels, whose mean is fixed, has rank |Ω| − 1 at most.
void require_rank(const KrigingOperator& op) {
  if (!op.field().periodic || op.field().nugget_variance > 0) return;
  const std::int64_t rank = op.covariance().grid().area() - 1;
  if (static_cast<std::int64_t>(op.unknowns()) > rank) {
    throw std::invalid_argument(fmt::format(
        "{} conditioning values of a periodic model that has rank {} at most, one noise driving its {} channels: the "
        "system is singular; a narrower border or the covariance of the plane has fewer or more, and {}",
        op.unknowns(), rank, op.channels(), nugget_advice()));
  }
}

struct Iteration {
  Vector k;
  int count = 0;
  std::string_view reason = "iterations";
};

/// Conjugate gradient for A k = b from zero; A a function of (x, out), M⁻¹ likewise or null.
template <class Apply, class Precondition>
Iteration conjugate_gradient(const Apply& apply, const Precondition* precondition, const Vector& b,
                             const SolveOptions& options, const SolveObserver& observer) {
  Iteration result;
  result.k = Vector::Zero(b.size());
  Vector r = b, z = b, p, q(b.size());
  const double start = b.norm();
  if (start == 0) {
    result.reason = "tolerance";
    return result;
  }
  double rz = 0;
  while (result.count < options.iterations) {
    if (precondition != nullptr) {
      (*precondition)(r, z);
    } else {
      z = r;
    }
    const double next = r.dot(z);
    if (result.count == 0) {
      p = z;
    } else {
      p = z + (next / rz) * p;
    }
    rz = next;
    apply(p, q);
    const double curvature = p.dot(q);
    if (!(curvature > 0) || !(rz > 0)) {
      result.reason = "breakdown";
      return result;
    }
    const double step = rz / curvature;
    result.k += step * p;
    r -= step * q;
    ++result.count;
    const double residual = r.norm() / start;
    if (observer) observer(result.count, view(result.k), residual);
    if (residual <= options.tolerance) {
      result.reason = "tolerance";
      return result;
    }
  }
  return result;
}

}  // namespace

std::string_view name_of(KrigingSolver solver) {
  for (const auto& [value, name] : solver_names) {
    if (value == solver) return name;
  }
  throw std::invalid_argument("not a solver");
}

KrigingSolver kriging_solver(std::string_view name) {
  for (const auto& [value, known] : solver_names) {
    if (known == name) return value;
  }
  throw std::invalid_argument(
      fmt::format("solver \"{}\": expected auto, dense, cg, schwarz, circulant or normal", name));
}

/// The Cholesky factor of the whole matrix.
class KrigingSystem::DenseFactor {
 public:
  explicit DenseFactor(const KrigingOperator& op) : matrix_(op.unknowns(), op.unknowns()) {
    std::vector<int> all(static_cast<std::size_t>(op.points()));
    std::iota(all.begin(), all.end(), 0);
    op.fill_matrix(all, op.covariance().table(op.box().size), matrix_.data());
    const double largest = matrix_.diagonal().maxCoeff();
    factor_.emplace(matrix_);
    const double least = matrix_.diagonal().minCoeff();
    if (factor_->info() != Eigen::Success || singular_pivots(least * least, largest, op.unknowns())) {
      fail_not_positive(op.unknowns());
    }
  }

  Vector solve(const Vector& right) const { return factor_->solve(right); }
  std::size_t bytes() const { return static_cast<std::size_t>(matrix_.size()) * sizeof(double); }

 private:
  Eigen::MatrixXd matrix_;
  std::optional<Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>> factor_;
};

struct KrigingSystem::Parts {
  const KrigingOperator& op;
  SolveOptions options;
  std::optional<DenseFactor> dense = {};
  std::unique_ptr<Preconditioner> preconditioner = nullptr;
  double setup_seconds = 0;
};

KrigingSystem::KrigingSystem(const KrigingOperator& op, const SolveOptions& options)
    : parts_(new Parts{.op = op, .options = options}) {
  require_rank(op);
  const Clock::time_point start = Clock::now();
  parts_->options.solver = chosen(options.solver, op);
  switch (parts_->options.solver) {
    case KrigingSolver::dense:
      if (op.unknowns() > most_dense_unknowns) {
        throw std::invalid_argument(
            fmt::format("a dense matrix of {} unknowns: expected at most {}; solver schwarz takes any number",
                        op.unknowns(), most_dense_unknowns));
      }
      parts_->dense.emplace(op);
      break;
    case KrigingSolver::schwarz:
      parts_->preconditioner = schwarz_preconditioner(op);
      break;
    case KrigingSolver::circulant:
      parts_->preconditioner = circulant_preconditioner(op);
      break;
    case KrigingSolver::automatic:
    case KrigingSolver::cg:
    case KrigingSolver::normal:
      break;
  }
  parts_->setup_seconds = seconds_since(start);
}

KrigingSystem::~KrigingSystem() = default;
KrigingSystem::KrigingSystem(KrigingSystem&&) noexcept = default;

KrigingSystem::Solution KrigingSystem::solve(std::span<const double> right_side, const SolveObserver& observer) const {
  const KrigingOperator& op = parts_->op;
  const SolveOptions& options = parts_->options;
  if (right_side.size() != op.unknowns()) {
    throw std::invalid_argument(
        fmt::format("a right side of {} numbers: expected {}", right_side.size(), op.unknowns()));
  }
  const Clock::time_point start = Clock::now();
  KrigingOperator::Workspace workspace;
  const Vector b = Eigen::Map<const Vector>(right_side.data(), std::ssize(right_side));
  const auto apply = [&](const Vector& x, Vector& out) { op.apply(view(x), view(out), workspace); };
  Vector between(b.size());
  const auto apply_twice = [&](const Vector& x, Vector& out) {
    apply(x, between);
    apply(between, out);
  };
  const auto precondition = [&](const Vector& x, Vector& out) { parts_->preconditioner->apply(view(x), view(out)); };

  Iteration iteration;
  if (options.solver == KrigingSolver::dense) {
    iteration = {.k = parts_->dense->solve(b), .count = 0, .reason = "direct"};
  } else if (options.solver == KrigingSolver::normal) {
    Vector product(b.size());
    apply(b, product);
    const decltype(precondition)* none = nullptr;
    iteration = conjugate_gradient(apply_twice, none, product, options, observer);
  } else {
    iteration = conjugate_gradient(apply, parts_->preconditioner ? &precondition : nullptr, b, options, observer);
  }
  const double solve_seconds = seconds_since(start);
  // A right side of zero has nothing to be relative to.
  Vector product(b.size());
  apply(iteration.k, product);
  const double norm = b.norm();
  const double residual = norm > 0 ? (b - product).norm() / norm : 0;
  if (iteration.reason == "breakdown" && residual > std::max(options.tolerance, 1e-6)) fail_not_positive(op.unknowns());
  return {.k = {iteration.k.begin(), iteration.k.end()},
          .summary = {.solver = options.solver,
                      .unknowns = op.unknowns(),
                      .iterations = iteration.count,
                      .residual = residual,
                      .reason = iteration.reason,
                      .setup_seconds = parts_->setup_seconds,
                      .solve_seconds = solve_seconds,
                      .bytes = bytes()}};
}

KrigingSolver KrigingSystem::solver() const { return parts_->options.solver; }

double KrigingSystem::setup_seconds() const { return parts_->setup_seconds; }

std::size_t KrigingSystem::bytes() const {
  if (parts_->dense) return parts_->dense->bytes();
  return parts_->preconditioner ? parts_->preconditioner->bytes() : 0;
}

}  // namespace textonbench
