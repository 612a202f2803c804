// Kriging systems as they are solved: all null for a model that is not inpainting, and take the model's own solver and
// options. The right side is that of the kriging component, (u − m)_C.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// True ‖φ − Γ k‖ / ‖φ‖.
std::optional<double> kriging_residual(const Model& model, const Target& target, const Domain& domain);
/// Iterations until the model's tolerance or limit; 0 of a dense solution.
std::optional<double> kriging_iterations(const Model& model, const Target& target, const Domain& domain);
std::optional<double> kriging_unknowns(const Model& model, const Target& target, const Domain& domain);
/// Seconds of what is set up once for all right sides, of one solution, and of one iteration (the median; null of a
/// dense solution).
std::optional<double> kriging_setup_seconds(const Model& model, const Target& target, const Domain& domain);
std::optional<double> kriging_solve_seconds(const Model& model, const Target& target, const Domain& domain);
std::optional<double> kriging_iteration_seconds(const Model& model, const Target& target, const Domain& domain);
/// Bytes that the solver keeps beside the operator.
std::optional<double> kriging_bytes(const Model& model, const Target& target, const Domain& domain);

// By dense algebra: null above 5000 unknowns. Of a singular matrix the error throws std::invalid_argument, and the
// condition number is null.

/// Root mean square over the missing pixels of the difference between the kriging component and that of the dense
/// solution, over the standard deviation of the model.
std::optional<double> kriging_error(const Model& model, const Target& target, const Domain& domain);
/// Largest over least eigenvalue of Γ_CC, by power iteration on it and on its Cholesky factor.
std::optional<double> kriging_condition_number(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
