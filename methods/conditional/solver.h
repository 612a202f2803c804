// Iterative and direct solution of Γ_CC k = φ.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "methods/conditional/kriging.h"
#include "methods/conditional/preconditioner.h"

namespace textonbench {

/// How the kriging system is solved.
enum class KrigingSolver {
  automatic,  ///< dense up to `automatic_dense_unknowns`, Schwarz above
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

/// Up to here `automatic` takes the whole matrix: 8 MB, a few hundredths of a second.
inline constexpr std::size_t automatic_dense_unknowns = 1000;
/// Above, `dense` is refused: 800 MB.
inline constexpr std::size_t most_dense_unknowns = 10000;

struct SolveOptions {
  KrigingSolver solver = KrigingSolver::automatic;
  /// Stop at ‖φ − Γ k‖ <= tolerance ‖φ‖, as the iteration's recurrence has it (of `normal`: ‖Γ(φ − Γ k)‖ by ‖Γ φ‖).
  double tolerance = 1e-6;
  int iterations = 1000;  ///< at most
};

/// How a solution came about. Not reaching the tolerance is told here and is no exception.
struct SolveSummary {
  KrigingSolver solver = KrigingSolver::automatic;  ///< the one used, never automatic
  std::size_t unknowns = 0;
  int iterations = 0;        ///< 0 for dense
  double residual = 0;       ///< true ‖φ − Γ k‖ / ‖φ‖, computed afresh
  std::string_view reason;   ///< why it stopped: "direct", "tolerance", "iterations" or "breakdown"
  double setup_seconds = 0;  ///< of the system, once for all right-hand sides
  double solve_seconds = 0;
  std::size_t bytes = 0;  ///< of what the solver keeps beside the operator

  bool converged() const { return reason == "direct" || reason == "tolerance"; }
};

/// Called after every iteration with the current k and the residual of the recurrence, relative to its start.
using SolveObserver = std::function<void(int iteration, std::span<const double> k, double residual)>;

/// A solver set up once for one operator (which must outlive it), for any number of right-hand sides.
class KrigingSystem {
 public:
  /// Throws std::invalid_argument, telling the nugget that would help, when the matrix is singular: on a torus without
  /// a nugget whenever there are as many unknowns as pixels, because one noise drives all channels; otherwise when a
  /// Cholesky factor has a pivot that is rounding. Throws std::invalid_argument above most_dense_unknowns.
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
  class DenseFactor;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace textonbench
