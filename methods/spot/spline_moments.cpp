#include "methods/spot/spline_moments.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "methods/base/bspline.h"

namespace textonbench {
namespace {

struct QuadratureNode {
  double position, weight;
};

/// Gauss-Legendre nodes on [0, 1], exact for polynomials of degree 2 count − 1 (Golub and Welsch 1969).
std::vector<QuadratureNode> gauss_legendre(int count) {
  Eigen::VectorXd below(count - 1);
  for (int i = 1; i < count; ++i) {
    below(i - 1) = i / std::sqrt(4.0 * i * i - 1);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::VectorXd::Zero(count), below);
  std::vector<QuadratureNode> nodes;
  nodes.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double first = solver.eigenvectors()(0, i);
    nodes.push_back({(1 + solver.eigenvalues()(i)) / 2, first * first});
  }
  return nodes;
}

/// Values of Σ_j α(j) β(x − j) at one place in each cell between knots, of coefficients along the columns.
Eigen::MatrixXd sample_columns(const Eigen::MatrixXd& coefficients, int order, double position) {
  const auto weights = bspline_taps(order, order % 2 == 0 ? position - 0.5 : position).weights;
  Eigen::MatrixXd samples = Eigen::MatrixXd::Zero(coefficients.rows() + order, coefficients.cols());
  for (int i = 0; i <= order; ++i) {
    samples.middleRows(order - i, coefficients.rows()) += weights[static_cast<std::size_t>(i)] * coefficients;
  }
  return samples;
}

}  // namespace

std::vector<double> spline_kurtosis(const SplineTexton& texton) {
  const Texton& coefficients = texton.coefficients;
  // h⁴ is of degree 4 order in each coordinate of a cell.
  const std::vector<QuadratureNode> nodes = gauss_legendre(2 * texton.order + 1);
  std::vector<double> kurtosis;
  kurtosis.reserve(static_cast<std::size_t>(coefficients.channels()));
  for (int c = 0; c < coefficients.channels(); ++c) {
    double second = 0;
    double fourth = 0;
    for (const Image& kernel : coefficients.kernels) {
      Eigen::MatrixXd alpha(kernel.height(), kernel.width());
      for (int y = 0; y < kernel.height(); ++y) {
        for (int x = 0; x < kernel.width(); ++x) {
          alpha(y, x) = static_cast<double>(kernel.at(c, x, y));
        }
      }
      for (const QuadratureNode& down : nodes) {
        const Eigen::MatrixXd rows = sample_columns(alpha, texton.order, down.position).transpose();
        for (const QuadratureNode& across : nodes) {
          const auto squares = sample_columns(rows, texton.order, across.position).array().square().eval();
          second += down.weight * across.weight * squares.sum();
          fourth += down.weight * across.weight * squares.square().sum();
        }
      }
    }
    const double impacts = texton.support_area * static_cast<double>(coefficients.kernels.size());
    kurtosis.push_back(second > 0 ? impacts * fourth / (second * second) : 0);
  }
  return kurtosis;
}

}  // namespace textonbench
