#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "methods/base/parallel.h"
#include "methods/conditional/preconditioner.h"

namespace textonbench {
namespace {

/// Cholesky factor of a symmetric matrix, the columns of its lower triangle one after the other.
class PackedFactor {
 public:
  PackedFactor() = default;
  /// `matrix` is overwritten. Throws std::invalid_argument when it is singular.
  explicit PackedFactor(Eigen::MatrixXd& matrix) : size_(matrix.rows()) {
    const double largest = matrix.diagonal().maxCoeff();
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(matrix);
    const double least = matrix.diagonal().minCoeff();
    if (factor.info() != Eigen::Success || singular_pivots(least * least, largest, static_cast<std::size_t>(size_))) {
      throw std::invalid_argument(
          fmt::format("the covariance of {} neighboring values is singular; {}", size_, nugget_advice()));
    }
    data_.reserve(static_cast<std::size_t>(size_ * (size_ + 1) / 2));
    for (Eigen::Index j = 0; j < size_; ++j) {
      data_.push_back(static_cast<float>(1 / matrix(j, j)));
      for (Eigen::Index i = j + 1; i < size_; ++i) data_.push_back(static_cast<float>(matrix(i, j)));
    }
  }

  /// x = (L Lᵀ)⁻¹ x.
  void solve(Eigen::VectorXf& x) const {
    const float* column = data_.data();
    for (Eigen::Index j = 0; j < size_; ++j) {
      const Eigen::Index below = size_ - j - 1;
      x[j] *= column[0];
      x.tail(below) -= x[j] * Eigen::Map<const Eigen::VectorXf>(column + 1, below);
      column += below + 1;
    }
    for (Eigen::Index j = size_ - 1; j >= 0; --j) {
      const Eigen::Index below = size_ - j - 1;
      column -= below + 1;
      x[j] = (x[j] - Eigen::Map<const Eigen::VectorXf>(column + 1, below).dot(x.tail(below))) * column[0];
    }
  }

  std::size_t bytes() const { return data_.size() * sizeof(float); }

 private:
  Eigen::Index size_ = 0;
  std::vector<float> data_;
};

int distance(const Rectangle& box, const Pixel& p) {
  const int dx = std::max({box.x - p.x, 0, p.x - (box.x + box.size.width - 1)});
  const int dy = std::max({box.y - p.y, 0, p.y - (box.y + box.size.height - 1)});
  return std::max(dx, dy);
}

Rectangle box_of_points(std::span<const Pixel> pixels, std::span<const int> points) {
  std::vector<Pixel> own;
  own.reserve(points.size());
  for (const int i : points) own.push_back(pixels[static_cast<std::size_t>(i)]);
  return bounding_box(own);
}

/// Cuts the points in two across the longer side of their box until no part has more than `most`.
void bisect(std::span<const Pixel> pixels, std::span<int> points, std::size_t most,
            std::vector<std::span<int>>& clusters) {
  if (points.size() <= most) {
    clusters.push_back(points);
    return;
  }
  const Rectangle box = box_of_points(pixels, points);
  const bool across = box.size.width >= box.size.height;
  const auto before = [&](int i, int j) {
    const Pixel& a = pixels[static_cast<std::size_t>(i)];
    const Pixel& b = pixels[static_cast<std::size_t>(j)];
    return across ? std::pair(a.x, a.y) < std::pair(b.x, b.y) : std::pair(a.y, a.x) < std::pair(b.y, b.x);
  };
  const std::size_t half = points.size() / 2;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half), points.end(), before);
  bisect(pixels, points.first(half), most, clusters);
  bisect(pixels, points.subspan(half), most, clusters);
}

/// Points by square cells, to find the neighbors of a box.
class PointGrid {
 public:
  PointGrid(std::span<const Pixel> pixels, int cell) : pixels_(pixels), cell_(cell) {
    for (const Pixel& pixel : pixels) {
      columns_ = std::max(columns_, pixel.x / cell + 1);
      rows_ = std::max(rows_, pixel.y / cell + 1);
    }
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::size_t place = static_cast<std::size_t>(pixels[i].y / cell) * static_cast<std::size_t>(columns_);
      cells_[place + static_cast<std::size_t>(pixels[i].x / cell)].push_back(static_cast<int>(i));
    }
  }

  /// The points of the core, and of the others within `reach` of its box the nearest, `most` in all.
  std::vector<int> grown(std::span<int> core, int reach, std::size_t most) const {
    const Rectangle box = box_of_points(pixels_, core);
    std::ranges::sort(core);
    std::vector<std::pair<int, int>> found;
    for (int row = std::max(0, box.y - reach) / cell_;
         row <= std::min(rows_ - 1, (box.y + box.size.height - 1 + reach) / cell_); ++row) {
      for (int column = std::max(0, box.x - reach) / cell_;
           column <= std::min(columns_ - 1, (box.x + box.size.width - 1 + reach) / cell_); ++column) {
        for (const int i : cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                                  static_cast<std::size_t>(column)]) {
          const int away =
              std::ranges::binary_search(core, i) ? -1 : distance(box, pixels_[static_cast<std::size_t>(i)]);
          if (away <= reach) found.emplace_back(away, i);
        }
      }
    }
    std::ranges::sort(found);
    found.resize(std::min(found.size(), most));
    std::vector<int> points(found.size());
    std::ranges::transform(found, points.begin(), &std::pair<int, int>::second);
    return points;
  }

 private:
  std::span<const Pixel> pixels_;
  int cell_, columns_ = 1, rows_ = 1;
  std::vector<std::vector<int>> cells_;
};

class Schwarz final : public Preconditioner {
 public:
  Schwarz(const KrigingOperator& op, const SchwarzOptions& options) : channels_(op.channels()), points_(op.points()) {
    const std::span<const Pixel> pixels = op.conditioning_pixels();
    std::vector<int> all(pixels.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<std::span<int>> cores;
    bisect(pixels, all, static_cast<std::size_t>(options.cluster_pixels), cores);
    const double bytes_each = static_cast<double>(options.most_bytes) / static_cast<double>(cores.size());
    const auto fitting = static_cast<int>(std::sqrt(bytes_each / (2.0 * channels_ * channels_)));
    const auto most =
        static_cast<std::size_t>(std::max(options.cluster_pixels, std::min(options.most_pixels, fitting)));
    const PointGrid grid(pixels, std::max(1, options.overlap));
    Extent reach{1, 1};
    clusters_.reserve(cores.size());
    for (const std::span<int> core : cores) {
      clusters_.push_back({.points = grid.grown(core, options.overlap, most), .factor = {}});
      const Rectangle box = box_of_points(pixels, clusters_.back().points);
      reach = {std::max(reach.width, box.size.width), std::max(reach.height, box.size.height)};
    }
    const CovarianceTable table = op.covariance().table(reach);
    parallel_for(static_cast<int>(clusters_.size()), [&](int i) {
      Cluster& cluster = clusters_[static_cast<std::size_t>(i)];
      const auto side = static_cast<Eigen::Index>(cluster.points.size()) * channels_;
      Eigen::MatrixXd matrix(side, side);
      op.fill_matrix(cluster.points, table, matrix.data());
      cluster.factor = PackedFactor(matrix);
    });
  }

  void apply(std::span<const double> residual, std::span<double> out) const override {
    std::vector<Eigen::VectorXf> corrections(clusters_.size());
    // Single precision has a narrow range.
    const double norm = Eigen::Map<const Eigen::VectorXd>(residual.data(), std::ssize(residual)).norm();
    const double scale = norm > 0 ? 1 / norm : 1;
    parallel_for(static_cast<int>(clusters_.size()), [&](int i) {
      const Cluster& cluster = clusters_[static_cast<std::size_t>(i)];
      const auto n = static_cast<Eigen::Index>(cluster.points.size());
      Eigen::VectorXf x(n * channels_);
      for (int c = 0; c < channels_; ++c) {
        for (Eigen::Index j = 0; j < n; ++j) {
          x[c * n + j] = static_cast<float>(scale * residual[unknown(c, cluster.points[static_cast<std::size_t>(j)])]);
        }
      }
      cluster.factor.solve(x);
      corrections[static_cast<std::size_t>(i)] = std::move(x);
    });
    std::ranges::fill(out, 0.0);
    for (std::size_t i = 0; i < clusters_.size(); ++i) {
      const std::vector<int>& points = clusters_[i].points;
      const auto n = static_cast<Eigen::Index>(points.size());
      for (int c = 0; c < channels_; ++c) {
        for (Eigen::Index j = 0; j < n; ++j) {
          out[unknown(c, points[static_cast<std::size_t>(j)])] += norm * static_cast<double>(corrections[i][c * n + j]);
        }
      }
    }
  }

  std::size_t bytes() const override {
    return std::accumulate(clusters_.begin(), clusters_.end(), std::size_t{0},
                           [](std::size_t sum, const Cluster& cluster) {
                             return sum + cluster.factor.bytes() + 4 * cluster.points.size();
                           });
  }

 private:
  struct Cluster {
    std::vector<int> points;
    PackedFactor factor;
  };

  std::size_t unknown(int channel, int point) const {
    return static_cast<std::size_t>(channel) * static_cast<std::size_t>(points_) + static_cast<std::size_t>(point);
  }

  int channels_, points_;
  std::vector<Cluster> clusters_;
};

}  // namespace

std::unique_ptr<Preconditioner> schwarz_preconditioner(const KrigingOperator& op, const SchwarzOptions& options) {
  return std::make_unique<Schwarz>(op, options);
}

}  // namespace textonbench
