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

/// Sums over the kernels of one channel. s is given by its values at the nodes of every cell between knots, node by
/// node and cell by cell: of degree 2 order in each coordinate of a cell, it has 2 order + 1 of them.
struct ChannelIntegrals {
  double second = 0;  ///< ∫ s
  double fourth = 0;  ///< Σ_k ∫ h_k⁴
  Eigen::MatrixXd s;
};

ChannelIntegrals integrate_channel(const SplineTexton& texton, int channel, const std::vector<QuadratureNode>& nodes) {
  const auto [width, height] = texton.coefficients.extent();
  const auto count = static_cast<Eigen::Index>(nodes.size());
  ChannelIntegrals sums;
  sums.s = Eigen::MatrixXd::Zero(count * (height + texton.order), count * (width + texton.order));
  for (const Image& kernel : texton.coefficients.kernels) {
    Eigen::MatrixXd alpha(height, width);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        alpha(y, x) = static_cast<double>(kernel.at(channel, x, y));
      }
    }
    for (Eigen::Index j = 0; j < count; ++j) {
      const QuadratureNode& down = nodes[static_cast<std::size_t>(j)];
      const Eigen::MatrixXd rows = sample_columns(alpha, texton.order, down.position).transpose();
      for (Eigen::Index i = 0; i < count; ++i) {
        const QuadratureNode& across = nodes[static_cast<std::size_t>(i)];
        const Eigen::MatrixXd squares = sample_columns(rows, texton.order, across.position).cwiseAbs2().transpose();
        sums.second += down.weight * across.weight * squares.sum();
        sums.fourth += down.weight * across.weight * squares.squaredNorm();
        sums.s(Eigen::seqN(j, height + texton.order, count), Eigen::seqN(i, width + texton.order, count)) += squares;
      }
    }
  }
  return sums;
}

/// Enough nodes for h⁴, of degree 4 order in each coordinate of a cell.
std::vector<QuadratureNode> nodes_of_order(int order) { return gauss_legendre(2 * order + 1); }

/// ∫ from 0 to t of the polynomial that is 1 at one of the nodes and 0 at the others.
double integrate_nodal(const std::vector<QuadratureNode>& nodes, std::size_t node, double t) {
  double sum = 0;
  for (const QuadratureNode& at : nodes) {
    double value = 1;
    for (std::size_t other = 0; other < nodes.size(); ++other) {
      if (other == node) continue;
      value *= (t * at.position - nodes[other].position) / (nodes[node].position - nodes[other].position);
    }
    sum += at.weight * value;
  }
  return t * sum;
}

/// R such that uᵀ R v = ∫ ū v̄ for functions u, v on `cells` cells in a row, polynomials in each, that are given by
/// their values at the nodes; ū is the mean over the interval of length `side` about a point.
Eigen::MatrixXd mean_products(const std::vector<QuadratureNode>& nodes, int cells, double side) {
  const auto count = static_cast<Eigen::Index>(nodes.size());
  std::vector<double> knots;
  knots.reserve(2 * static_cast<std::size_t>(cells) + 2);
  for (int i = 0; i <= cells; ++i) {
    knots.push_back(i - side / 2);
    knots.push_back(i + side / 2);
  }
  std::ranges::sort(knots);
  // Between knots a mean is a polynomial of a degree one above that of the function.
  const std::vector<QuadratureNode> inner = gauss_legendre(static_cast<int>(count) + 1);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(count * cells, count * cells);
  for (std::size_t piece = 1; piece < knots.size(); ++piece) {
    const double length = knots[piece] - knots[piece - 1];
    for (const QuadratureNode& node : inner) {
      const double low = knots[piece - 1] + length * node.position - side / 2;
      const auto first = static_cast<Eigen::Index>(std::clamp(std::floor(low), 0.0, double(cells)));
      const auto end = static_cast<Eigen::Index>(std::clamp(std::ceil(low + side), 0.0, double(cells)));
      if (first >= end) continue;
      Eigen::VectorXd mean(count * (end - first));
      for (Eigen::Index cell = first; cell < end; ++cell) {
        const double from = std::clamp(low - static_cast<double>(cell), 0.0, 1.0);
        const double to = std::clamp(low + side - static_cast<double>(cell), 0.0, 1.0);
        for (Eigen::Index i = 0; i < count; ++i) {
          const auto at = static_cast<std::size_t>(i);
          mean(count * (cell - first) + i) = (integrate_nodal(nodes, at, to) - integrate_nodal(nodes, at, from)) / side;
        }
      }
      products.block(count * first, count * first, mean.size(), mean.size()).noalias() +=
          length * node.weight * mean * mean.transpose();
    }
  }
  return products;
}

}  // namespace

std::vector<double> spline_kurtosis(const SplineTexton& texton) {
  const std::vector<QuadratureNode> nodes = nodes_of_order(texton.order);
  const double impacts = texton.support_area * static_cast<double>(texton.coefficients.kernels.size());
  std::vector<double> kurtosis;
  kurtosis.reserve(static_cast<std::size_t>(texton.coefficients.channels()));
  for (int c = 0; c < texton.coefficients.channels(); ++c) {
    const ChannelIntegrals sums = integrate_channel(texton, c, nodes);
    kurtosis.push_back(sums.second > 0 ? impacts * sums.fourth / (sums.second * sums.second) : 0);
  }
  return kurtosis;
}

std::vector<double> stratified_spline_kurtosis(const SplineTexton& texton, double mni) {
  const std::vector<QuadratureNode> nodes = nodes_of_order(texton.order);
  const auto [width, height] = texton.coefficients.extent();
  const double area = texton.support_area / mni;
  const Eigen::MatrixXd across = mean_products(nodes, width + texton.order, std::sqrt(area));
  const Eigen::MatrixXd down = mean_products(nodes, height + texton.order, std::sqrt(area));
  const auto kernels = static_cast<double>(texton.coefficients.kernels.size());
  std::vector<double> kurtosis;
  kurtosis.reserve(static_cast<std::size_t>(texton.coefficients.channels()));
  for (int c = 0; c < texton.coefficients.channels(); ++c) {
    const ChannelIntegrals sums = integrate_channel(texton, c, nodes);
    const double of_means = (down * sums.s * across).cwiseProduct(sums.s).sum();
    const double cumulant = kernels * sums.fourth - 3 * of_means;
    kurtosis.push_back(sums.second > 0 ? area * cumulant / (sums.second * sums.second) : 0);
  }
  return kurtosis;
}

}  // namespace textonbench
