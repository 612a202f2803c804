// Unconstrained minimization of a smooth function by limited-memory BFGS (Nocedal and Wright, Numerical Optimization,
// algorithm 7.5) with a backtracking line search.
//
// Our own loop and not Ceres' GradientProblemSolver, because the first step is known here (one alternating projection)
// and the budget is one of evaluations, neither of which Ceres takes, and because Ceres brings 25 more packages to the
// build. In number of evaluations they are equals: four textons of a 128 x 128 exemplar took Ceres a third more for the
// same error, one texton a little fewer.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace textonbench {

/// Value at x, and the gradient written into its second argument.
using GradientFunction = std::function<double(std::span<const double> x, std::span<double> gradient)>;

struct LbfgsOptions {
  int evaluations = 60;     ///< at most that many calls of the function
  int memory = 20;          ///< pairs of steps and changes of the gradient that are kept
  double first_step = 1;    ///< of the gradient descent that starts
  double tolerance = 1e-9;  ///< stops when an iteration lowers the value by less than this times (1 + |value|)
};

struct LbfgsSummary {
  double value = 0;              ///< the lowest found, that of x on return
  int evaluations = 0;           ///< calls of the function
  std::vector<double> history;   ///< lowest value after each call
  std::string_view reason;       ///< "evaluations", "tolerance" or "no descent"
  std::vector<double> gradient;  ///< at x on return
};

/// Moves x to a point of lower value.
LbfgsSummary minimize_lbfgs(const GradientFunction& function, const LbfgsOptions& options, std::vector<double>& x);

}  // namespace textonbench
