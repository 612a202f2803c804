#include "methods/spot/lbfgs.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

namespace textonbench {
namespace {

double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

void add(double factor, std::span<const double> a, std::span<double> to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    to[i] += factor * a[i];
  }
}

/// The inverse Hessian that the last steps suggest.
class InverseHessian {
 public:
  InverseHessian(int memory, double first_step) : memory_(static_cast<std::size_t>(memory)), scale_(first_step) {}

  /// −H g, by the two-loop recursion.
  std::vector<double> descent(std::span<const double> gradient) const {
    std::vector<double> direction(gradient.begin(), gradient.end());
    std::vector<double> weights(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      weights[i] = dot(pairs_[i].step, direction) / pairs_[i].curvature;
      add(-weights[i], pairs_[i].change, direction);
    }
    for (double& d : direction) {
      d *= -scale_;
    }
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      add(-weights[i] - dot(pairs_[i].change, direction) / pairs_[i].curvature, pairs_[i].step, direction);
    }
    return direction;
  }

  /// A step and the change of the gradient along it; left out where the curvature is not positive.
  void learn(std::vector<double> step, std::vector<double> change) {
    const double curvature = dot(step, change);
    const double norm = dot(change, change);
    if (!(curvature > 1e-12 * norm)) {
      return;
    }
    scale_ = curvature / norm;
    pairs_.push_back({std::move(step), std::move(change), curvature});
    if (pairs_.size() > memory_) {
      pairs_.pop_front();
    }
  }

 private:
  struct Pair {
    std::vector<double> step, change;
    double curvature;
  };
  std::size_t memory_;
  double scale_;
  std::deque<Pair> pairs_;
};

}  // namespace

LbfgsSummary minimize_lbfgs(const GradientFunction& function, const LbfgsOptions& options, std::vector<double>& x) {
  constexpr double sufficient_decrease = 1e-4;
  constexpr double shortest_step = 1e-8;
  LbfgsSummary summary;
  summary.gradient.resize(x.size());
  std::vector<double> trial(x.size());
  std::vector<double> trial_gradient(x.size());
  const auto evaluate = [&](std::span<const double> at, std::span<double> gradient) {
    const double value = function(at, gradient);
    ++summary.evaluations;
    summary.history.push_back(summary.history.empty() ? value : std::min(value, summary.history.back()));
    return value;
  };

  summary.value = evaluate(x, summary.gradient);
  summary.reason = "evaluations";
  InverseHessian hessian(options.memory, options.first_step);
  while (summary.evaluations < options.evaluations) {
    const std::vector<double> direction = hessian.descent(summary.gradient);
    const double slope = dot(direction, summary.gradient);
    double value = summary.value;
    for (double length = 1; length > shortest_step && summary.evaluations < options.evaluations;) {
      trial = x;
      add(length, direction, trial);
      value = evaluate(trial, trial_gradient);
      if (value <= summary.value + sufficient_decrease * length * slope) {
        break;
      }
      // Lowest point of the parabola through the value, the slope and the new value, kept within sensible bounds.
      const double parabola = -slope * length * length / (2 * (value - summary.value - slope * length));
      length = std::clamp(parabola, 0.1 * length, 0.5 * length);
    }
    if (!(value < summary.value)) {
      summary.reason = summary.evaluations < options.evaluations ? "no descent" : "evaluations";
      break;
    }
    std::vector<double> step(x.size());
    std::vector<double> change(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      step[i] = trial[i] - x[i];
      change[i] = trial_gradient[i] - summary.gradient[i];
    }
    hessian.learn(std::move(step), std::move(change));
    const double decrease = summary.value - value;
    x.swap(trial);
    summary.gradient.swap(trial_gradient);
    summary.value = value;
    if (decrease < options.tolerance * (1 + std::abs(value))) {
      summary.reason = "tolerance";
      break;
    }
  }
  return summary;
}

}  // namespace textonbench
