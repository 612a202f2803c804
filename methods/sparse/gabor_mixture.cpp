#include "methods/sparse/gabor_mixture.h"

#include <ceres/ceres.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/base/parallel.h"

namespace textonbench {
namespace {

/// Log of the weight, the center, and L of the covariance L L^T: log l_11, l_21, log l_22.
constexpr int numbers_a_gaussian = 6;

/// Pairs (k, −k) count once.
bool is_upper(Extent raster, int x, int y) { return y > 0 && 2 * y < raster.height ? true : 2 * x <= raster.width; }

double nearest_turn(double d) { return d - std::round(d); }

/// A Gaussian as its numbers have it, with what its value and derivatives take.
struct ExpandedGaussian {
  double weight, x, y, l11, l21, l22, peak;

  explicit ExpandedGaussian(const double* n)
      : weight(std::exp(n[0])),
        x(n[1]),
        y(n[2]),
        l11(std::exp(n[3])),
        l21(n[4]),
        l22(std::exp(n[5])),
        peak(weight / (4 * std::numbers::pi * l11 * l22)) {}

  /// Adds half of the Gaussian around `sign` times its center, and the derivatives by its numbers where they are
  /// wanted.
  double add(double fx, double fy, double sign, double* derivatives) const {
    const double z1 = nearest_turn(fx - sign * x) / l11;
    const double z2 = (nearest_turn(fy - sign * y) - l21 * z1) / l22;
    const double square = z1 * z1 + z2 * z2;
    if (square > 60) return 0;
    const double g = peak * std::exp(-0.5 * square);
    if (derivatives != nullptr) {
      derivatives[0] += g;
      derivatives[1] += sign * g * (z1 - z2 * l21 / l22) / l11;
      derivatives[2] += sign * g * z2 / l22;
      derivatives[3] += g * (z1 * z1 - z2 * l21 * z1 / l22 - 1);
      derivatives[4] += g * z1 * z2 / l22;
      derivatives[5] += g * (z2 * z2 - 1);
    }
    return g;
  }
};

/// sqrt q − sqrt p along a row of bins.
class RowOfRoots final : public ceres::CostFunction {
 public:
  RowOfRoots(const Image& power, int row, double floor, int gaussians)
      : raster_(power.extent()), row_(row), floor_(floor), gaussians_(gaussians) {
    for (int x = 0; x < raster_.width; ++x) {
      if ((x == 0 && row == 0) || !is_upper(raster_, x, row)) continue;
      columns_.push_back(x);
      roots_.push_back(std::sqrt(double{power.at(0, x, row)} * static_cast<double>(raster_.area())));
    }
    set_num_residuals(static_cast<int>(columns_.size()));
    mutable_parameter_block_sizes()->push_back(numbers_a_gaussian * gaussians);
  }

  bool is_empty() const { return columns_.empty(); }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const bool with_derivatives = jacobians != nullptr && jacobians[0] != nullptr;
    const std::size_t count = columns_.size(), width = static_cast<std::size_t>(numbers_a_gaussian) * gaussians_;
    std::fill(residuals, residuals + count, floor_);
    if (with_derivatives) std::fill(jacobians[0], jacobians[0] + count * width, 0.0);
    const double fy = static_cast<double>(row_) / raster_.height;
    for (std::size_t k = 0; k < gaussians_; ++k) {
      const ExpandedGaussian gaussian(parameters[0] + k * numbers_a_gaussian);
      for (std::size_t i = 0; i < count; ++i) {
        const double fx = static_cast<double>(columns_[i]) / raster_.width;
        double* derivatives = with_derivatives ? jacobians[0] + i * width + k * numbers_a_gaussian : nullptr;
        residuals[i] += gaussian.add(fx, fy, 1, derivatives) + gaussian.add(fx, fy, -1, derivatives);
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double root = std::sqrt(residuals[i]);
      if (with_derivatives) {
        for (std::size_t j = 0; j < width; ++j) jacobians[0][i * width + j] /= 2 * root;
      }
      residuals[i] = root - roots_[i];
    }
    return true;
  }

 private:
  Extent raster_;
  int row_;
  double floor_;
  std::size_t gaussians_;
  std::vector<int> columns_;
  std::vector<double> roots_;
};

double log_determinant(const Eigen::Matrix2d& m) { return std::log(m.determinant()); }

/// `other` as it is or around −center, whichever is nearer to `one`.
Eigen::Vector2d nearer_center(const PowerGaussian& one, const PowerGaussian& other) {
  const auto distance = [&](double sign) { return (one.center - sign * other.center).squaredNorm(); };
  return distance(1) <= distance(-1) ? other.center : Eigen::Vector2d(-other.center);
}

PowerGaussian merged(const PowerGaussian& one, const PowerGaussian& other) {
  const Eigen::Vector2d center = nearer_center(one, other), apart = one.center - center;
  const double sum = one.weight + other.weight, a = one.weight / sum, b = other.weight / sum;
  return {sum, a * one.center + b * center,
          a * one.covariance + b * other.covariance + a * b * apart * apart.transpose()};
}

double merging_cost(const PowerGaussian& one, const PowerGaussian& other) {
  const PowerGaussian both = merged(one, other);
  return both.weight * log_determinant(both.covariance) - one.weight * log_determinant(one.covariance) -
         other.weight * log_determinant(other.covariance);
}

/// For each Gaussian the one that it is merged with at least cost.
class MergingPartners {
 public:
  explicit MergingPartners(const std::vector<PowerGaussian>& all) : all_(all), partner_(all.size()), cost_(all.size()) {
    parallel_for(static_cast<int>(all.size()), [&](int i) { find(static_cast<std::size_t>(i)); });
  }

  std::size_t best() const { return static_cast<std::size_t>(std::ranges::min_element(cost_) - cost_.begin()); }
  std::size_t partner(std::size_t i) const { return partner_[i]; }

  /// The last Gaussian, `gone`, was `all`'s last and took the place of `removed`; `changed` is another one now.
  void after_merge(std::size_t changed, std::size_t removed) {
    const std::size_t gone = all_.size();
    partner_[removed] = partner_[gone], cost_[removed] = cost_[gone];
    partner_.pop_back(), cost_.pop_back();
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const bool is_stale =
          i == changed || i == removed || partner_[i] == changed || partner_[i] == removed || partner_[i] == gone;
      if (is_stale) {
        find(i);
      } else if (const double cost = merging_cost(all_[i], all_[changed]); cost < cost_[i]) {
        cost_[i] = cost, partner_[i] = changed;
      }
    }
  }

 private:
  void find(std::size_t i) {
    cost_[i] = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < all_.size(); ++j) {
      if (j == i) continue;
      if (const double cost = merging_cost(all_[i], all_[j]); cost < cost_[i]) cost_[i] = cost, partner_[i] = j;
    }
  }

  const std::vector<PowerGaussian>& all_;
  std::vector<std::size_t> partner_;
  std::vector<double> cost_;
};

std::vector<double> as_numbers(const std::vector<PowerGaussian>& gaussians) {
  std::vector<double> numbers;
  numbers.reserve(numbers_a_gaussian * gaussians.size());
  for (const PowerGaussian& g : gaussians) {
    const double l11 = std::sqrt(g.covariance(0, 0)), l21 = g.covariance(0, 1) / l11;
    const double l22 = std::sqrt(std::max(1e-12, g.covariance(1, 1) - l21 * l21));
    numbers.insert(numbers.end(), {std::log(g.weight), g.center.x(), g.center.y(), std::log(l11), l21, std::log(l22)});
  }
  return numbers;
}

std::vector<PowerGaussian> as_gaussians(const std::vector<double>& numbers) {
  std::vector<PowerGaussian> gaussians;
  gaussians.reserve(numbers.size() / numbers_a_gaussian);
  for (std::size_t at = 0; at < numbers.size(); at += numbers_a_gaussian) {
    const ExpandedGaussian g(numbers.data() + at);
    Eigen::Matrix2d covariance;
    covariance << g.l11 * g.l11, g.l11 * g.l21, g.l11 * g.l21, g.l21 * g.l21 + g.l22 * g.l22;
    gaussians.push_back({g.weight, {nearest_turn(g.x), nearest_turn(g.y)}, covariance});
  }
  return gaussians;
}

void set_bounds(const MixtureBounds& bounds, std::vector<double>& numbers, ceres::Problem& problem) {
  const auto bound = [&](std::size_t at, double low, double high) {
    numbers[at] = std::clamp(numbers[at], low, high);
    problem.SetParameterLowerBound(numbers.data(), static_cast<int>(at), low);
    problem.SetParameterUpperBound(numbers.data(), static_cast<int>(at), high);
  };
  for (std::size_t at = 0; at < numbers.size(); at += numbers_a_gaussian) {
    bound(at, numbers[at] - 12, numbers[at] + 6);
    bound(at + 1, -0.5, 0.5);
    bound(at + 2, -0.5, 0.5);
    bound(at + 3, std::log(bounds.least), std::log(bounds.most));
    bound(at + 4, -bounds.most, bounds.most);
    bound(at + 5, std::log(bounds.least), std::log(bounds.most));
  }
}

}  // namespace

std::vector<PowerGaussian> merge_gaussians(std::vector<PowerGaussian> all, int count) {
  MergingPartners partners(all);
  while (all.size() > static_cast<std::size_t>(count)) {
    const std::size_t one = partners.best(), other = partners.partner(one);
    const std::size_t kept = std::min(one, other), removed = std::max(one, other);
    all[kept] = merged(all[kept], all[removed]);
    all[removed] = all.back();
    all.pop_back();
    partners.after_merge(kept, removed);
  }
  return all;
}

PowerMixture fit_gaussians(const std::vector<PowerGaussian>& start, const Image& power, const MixtureBounds& bounds,
                           int iterations) {
  const int count = static_cast<int>(start.size());
  std::vector<double> numbers = as_numbers(start);
  double sum = 0;
  for (int y = 0; y < power.height(); ++y) {
    for (const float v : power.row(0, y)) sum += v;
  }
  ceres::Problem problem;
  problem.AddParameterBlock(numbers.data(), static_cast<int>(numbers.size()));
  for (int y = 0; 2 * y <= power.height(); ++y) {
    auto row = std::make_unique<RowOfRoots>(power, y, 1e-6 * sum, count);
    if (!row->is_empty()) problem.AddResidualBlock(row.release(), nullptr, numbers.data());
  }
  set_bounds(bounds, numbers, problem);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = iterations;
  options.function_tolerance = 1e-4;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  PowerMixture mixture;
  mixture.gaussians = as_gaussians(numbers);
  // Half of the squares of half of the bins, whose sum is that of the power times the number of bins.
  const double scale = 4 / (sum * static_cast<double>(power.extent().area()));
  for (const ceres::IterationSummary& step : summary.iterations) mixture.rme.push_back(std::sqrt(scale * step.cost));
  mixture.reason = summary.termination_type == ceres::CONVERGENCE      ? "tolerance"
                   : summary.termination_type == ceres::NO_CONVERGENCE ? "iterations"
                                                                       : "no descent";
  return mixture;
}

Image mixture_power(const std::vector<PowerGaussian>& gaussians, Extent raster) {
  const std::vector<double> numbers = as_numbers(gaussians);
  Image power(raster, 1);
  const double scale = 1 / static_cast<double>(raster.area());
  parallel_for(raster.height, [&](int y) {
    for (std::size_t at = 0; at < numbers.size(); at += numbers_a_gaussian) {
      const ExpandedGaussian gaussian(numbers.data() + at);
      for (int x = 0; x < raster.width; ++x) {
        const double fx = static_cast<double>(x) / raster.width, fy = static_cast<double>(y) / raster.height;
        power.at(0, x, y) +=
            static_cast<float>(scale * (gaussian.add(fx, fy, 1, nullptr) + gaussian.add(fx, fy, -1, nullptr)));
      }
    }
  });
  return power;
}

}  // namespace textonbench
