// Iterative and direct solution of Γ_CC k = φ.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "methods/conditional/kriging.h"

namespace textonbench {

/// How the kriging system is solved.
enum class KrigingSolver {
  automatic,  ///< dense up to `most_dense_unknowns`, Schwarz above
  dense,      ///< Cholesky of the whole matrix
  cg,         ///< conjugate gradient
  schwarz,    ///< conjugate gradient preconditioned by overlapping additive Schwarz
  circulant,  ///< conjugate gradient preconditioned by a circulant: kept as a measured comparison
  normal      ///< conjugate gradient on Γ² k = Γ φ, as the authors' code does by default
};
/// "auto", "dense", "cg", "schwarz", "circulant", "normal".
std::string_view name_of(KrigingSolver solver);
/// Throws std::invalid_argument with the names above.
KrigingSolver kriging_solver(std::string_view name);

/// A dense system of so many unknowns takes 1.5 GB·(n/14000)² and, on two cores, about as many seconds as its solution
/// by Schwarz.
inline constexpr int most_dense_unknowns = 2000;

struct SolveOptions {
  KrigingSolver solver = KrigingSolver::automatic;
  /// Stop at ‖φ − Γ k‖ <= tolerance ‖φ‖, as the iteration's recurrence has it (of `normal`: ‖Γ(φ − Γ k)‖ by ‖Γ φ‖).
  double tolerance = 1e-6;
  int iterations = 1000;  ///< at most
};

/// How a solution came about. Not reaching the tolerance is told here and is no exception.
struct SolveSummary {
  KrigingSolver solver = KrigingSolver::automatic;  ///< the one used, never automatic
  int unknowns = 0;
  int iterations = 0;       ///< 0 for dense
  double residual = 0;      ///< true ‖φ − Γ k‖ / ‖φ‖, computed afresh
  std::string_view reason;  ///< why it stopped: "direct", "tolerance", "iterations" or "breakdown"
  double setup_seconds = 0;
  double solve_seconds = 0;
  std::size_t bytes = 0;  ///< of what the solver keeps beside the operator

  bool converged() const { return reason == "direct" || reason == "tolerance"; }
};

/// Approximation of the inverse of an operator, symmetric and positive definite.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  virtual void apply(std::span<const double> residual, std::span<double> out) const = 0;
  virtual std::size_t bytes() const = 0;
};

/// Called after every iteration with the current k and the residual of the recurrence, relative to its start.
using SolveObserver = std::function<void(int iteration, std::span<const double> k, double residual)>;

/// A solver set up once for one operator (which must outlive it), for any number of right-hand sides.
class KrigingSystem {
 public:
  /// Throws std::invalid_argument when the matrix is singular to working precision and a Cholesky factor was asked for,
  /// telling the nugget that would help, and std::invalid_argument when a dense matrix would not fit.
  KrigingSystem(const KrigingOperator& op, const SolveOptions& options);
  ~KrigingSystem();
  KrigingSystem(KrigingSystem&&) noexcept;

  struct Solution {
    std::vector<double> k;
    SolveSummary summary;
  };
  /// Throws std::invalid_argument, telling the nugget that would help, when the operator turns out not to be positive
  /// definite.
  Solution solve(std::span<const double> right_side, const SolveObserver& observer = {}) const;

  KrigingSolver solver() const;
  double setup_seconds() const;
  std::size_t bytes() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace textonbench
