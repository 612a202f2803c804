#include "experiments/metrics/verbatim_copy.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <limits>
#include <stdexcept>

#include "methods/base/mask.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

constexpr int patch = 7;
constexpr int pairs = 128;

/// A patch at (x, y) a column.
void copy_patch(const Image& u, int x, int y, float* to) {
  for (int c = 0; c < u.channels(); ++c) {
    for (int j = 0; j < patch; ++j) {
      const float* row = u.row(c, y + j).data() + x;
      to = std::copy(row, row + patch, to);
    }
  }
}

class VerbatimCopy final : public SampleMetric {
 public:
  VerbatimCopy(const Target& target, const Domain& domain, Seed seed) : exemplar_(target.exemplar.pixels) {
    const auto too_small = [](Extent e) { return std::min(e.width, e.height) <= patch; };
    if (too_small(exemplar_.extent()) || too_small(domain.size)) {
      throw std::invalid_argument(fmt::format("verbatim_copy of {}x{} pixels from {}x{}: expected sides above {}",
                                              domain.size.width, domain.size.height, exemplar_.width(),
                                              exemplar_.height(), patch));
    }
    RandomSequence numbers(Stream(seed).child("verbatim copy"));
    places_.reserve(pairs);
    // The second pixel of a pair is to the right of the first.
    const int columns = domain.size.width - patch, rows = domain.size.height - patch + 1;
    for (int i = 0; i < pairs; ++i) {
      const auto x = static_cast<int>(numbers.below(static_cast<std::uint64_t>(columns)));
      places_.push_back({x, static_cast<int>(numbers.below(static_cast<std::uint64_t>(rows)))});
    }
  }

  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    const Eigen::Index entries = Eigen::Index{patch} * patch * sample.channels();
    Eigen::MatrixXf wanted(entries, 2 * pairs);
    for (int i = 0; i < 2 * pairs; ++i) {
      const Pixel& at = places_[static_cast<std::size_t>(i / 2)];
      copy_patch(sample, at.x + i % 2, at.y, wanted.col(i).data());
    }
    const std::vector<Pixel> nearest = nearest_patches(wanted);
    int copied = 0;
    for (std::size_t i = 0; i < nearest.size(); i += 2) {
      copied += nearest[i + 1] == Pixel{nearest[i].x + 1, nearest[i].y} ? 1 : 0;
    }
    return {static_cast<float>(copied) / pairs};
  }

  double value(std::span<const double> mean_statistic) const override { return mean_statistic.front(); }

 private:
  /// Of each column the place in the exemplar: the first one in rows from the top of those that are equally near.
  std::vector<Pixel> nearest_patches(const Eigen::MatrixXf& wanted) const {
    struct Best {
      float distance = std::numeric_limits<float>::infinity();
      int x = 0;
    };
    const int columns = exemplar_.width() - patch + 1, rows = exemplar_.height() - patch + 1;
    const auto count = static_cast<std::size_t>(wanted.cols());
    std::vector<Best> of_rows(count * static_cast<std::size_t>(rows));
    parallel_for(rows, [&](int y) {
      Eigen::MatrixXf patches(wanted.rows(), columns);
      for (int x = 0; x < columns; ++x) copy_patch(exemplar_, x, y, patches.col(x).data());
      const Eigen::RowVectorXf squares = patches.colwise().squaredNorm();
      const Eigen::MatrixXf products = wanted.transpose() * patches;
      for (std::size_t i = 0; i < count; ++i) {
        Best& best = of_rows[static_cast<std::size_t>(y) * count + i];
        for (int x = 0; x < columns; ++x) {
          const float distance = squares[x] - 2 * products(static_cast<Eigen::Index>(i), x);
          if (distance < best.distance) best = {distance, x};
        }
      }
    });
    std::vector<Pixel> nearest(count);
    for (std::size_t i = 0; i < count; ++i) {
      Best best;
      for (int y = 0; y < rows; ++y) {
        const Best& here = of_rows[static_cast<std::size_t>(y) * count + i];
        if (here.distance < best.distance) best = here, nearest[i] = {here.x, y};
      }
    }
    return nearest;
  }

  const Image& exemplar_;
  std::vector<Pixel> places_;
};

}  // namespace

std::unique_ptr<SampleMetric> verbatim_copy(const Target& target, const Domain& domain, Seed seed) {
  return std::make_unique<VerbatimCopy>(target, domain, seed);
}

}  // namespace textonbench
