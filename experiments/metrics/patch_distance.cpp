#include "experiments/metrics/patch_distance.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/SpecialFunctions>
#include <utility>

#include "experiments/metrics/target_law.h"

namespace textonbench {
namespace {

constexpr int scales = 3;
constexpr std::array<int, 2> sides{3, 8};
constexpr int projections = 512;
constexpr int most_patches = 10000;
constexpr int longest_lag = sides.back() * (1 << (scales - 1)) - 1;

/// Averages of 2 x 2 pixels; an odd last row or column is dropped.
Image halved(const Image& u) {
  Image result({u.width() / 2, u.height() / 2}, u.channels());
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < result.height(); ++y) {
      const auto upper = u.row(c, 2 * y);
      const auto lower = u.row(c, 2 * y + 1);
      const auto out = result.row(c, y);
      for (std::size_t x = 0; x < out.size(); ++x) {
        out[x] = 0.25F * (upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1]);
      }
    }
  }
  return result;
}

/// Covariance of patches after averaging box x box pixels, Γ'(v) = Σ_i τ(i_x) τ(i_y) Γ(box v + i) with the triangle
/// τ(i) = (box − |i|) / box². Entry (c, y, x) of a patch is at (c w + y) w + x.
Eigen::MatrixXd patch_covariance(const LagWindow& law, int box, int side) {
  const int span = 2 * side - 1;
  const auto averaged = [&](int c, int d, int vx, int vy) {
    double sum = 0;
    for (int j = 1 - box; j < box; ++j) {
      for (int i = 1 - box; i < box; ++i) {
        sum += (box - std::abs(i)) * (box - std::abs(j)) * law.at(c, d, box * vx + i, box * vy + j);
      }
    }
    return sum / std::pow(box, 4);
  };
  const int channels = law.channels();
  Eigen::MatrixXd covariance(channels * side * side, channels * side * side);
  Eigen::MatrixXd lags(span, span);
  for (int c = 0; c < channels; ++c) {
    for (int d = 0; d < channels; ++d) {
      for (int vy = 1 - side; vy < side; ++vy) {
        for (int vx = 1 - side; vx < side; ++vx) lags(vy + side - 1, vx + side - 1) = averaged(c, d, vx, vy);
      }
      for (int p = 0; p < side * side; ++p) {
        for (int q = 0; q < side * side; ++q) {
          covariance(c * side * side + p, d * side * side + q) =
              lags(p / side - q / side + side - 1, p % side - q % side + side - 1);
        }
      }
    }
  }
  return covariance;
}

/// a_i = n (φ(Φ⁻¹((i − 1)/n)) − φ(Φ⁻¹(i/n))): means of N(0, 1) between its n-quantiles.
std::vector<double> quantile_means(std::size_t n) {
  const auto density_at = [n](std::size_t i) {
    if (i == 0 || i == n) return 0.0;
    const double z = Eigen::numext::ndtri(static_cast<double>(i) / static_cast<double>(n));
    return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
  };
  std::vector<double> means(n);
  for (std::size_t i = 0; i < n; ++i) {
    means[i] = static_cast<double>(n) * (density_at(i) - density_at(i + 1));
  }
  return means;
}

/// Radix sort in three passes of 11 bits. Sorting is much of the metric's time, and std::sort takes 5 to 10 times as
/// long.
class FloatSorter {
 public:
  explicit FloatSorter(std::size_t size) : keys_(size), sorted_(size) {}

  /// i-th smallest value after sort().
  float operator[](std::size_t i) const {
    const std::uint32_t key = keys_[i];
    return std::bit_cast<float>(key & sign ? key ^ sign : ~key);
  }

  void sort(const float* values) {
    std::array<std::array<std::uint32_t, buckets>, passes> starts{};
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      const auto bits = std::bit_cast<std::uint32_t>(values[i]);
      keys_[i] = bits & sign ? ~bits : bits | sign;
      for (std::size_t pass = 0; pass < passes; ++pass) ++starts[pass][digit(keys_[i], pass)];
    }
    for (std::size_t pass = 0; pass < passes; ++pass) {
      std::uint32_t before = 0;
      for (std::uint32_t& start : starts[pass]) before += std::exchange(start, before);
      for (const std::uint32_t key : keys_) sorted_[starts[pass][digit(key, pass)]++] = key;
      keys_.swap(sorted_);
    }
  }

 private:
  static constexpr std::uint32_t sign = 0x80000000U;
  static constexpr std::size_t passes = 3;
  static constexpr std::size_t digit_bits = 11;
  static constexpr std::size_t buckets = std::size_t{1} << digit_bits;

  static std::size_t digit(std::uint32_t key, std::size_t pass) { return (key >> (digit_bits * pass)) % buckets; }

  std::vector<std::uint32_t> keys_, sorted_;
};

/// Patches of one side at one scale.
class PatchLaw {
 public:
  PatchLaw(const LagWindow& law, Extent image, int box, int side, int directions, const Stream& stream) : side_(side) {
    spacing_ = std::max(1, side / 2);
    while (count(image) > most_patches) ++spacing_;
    means_ = quantile_means(static_cast<std::size_t>(count(image)));

    const Eigen::MatrixXd covariance = patch_covariance(law, box, side);
    double variance = 0;
    for (int c = 0; c < law.channels(); ++c) variance += law.at(c, c, 0, 0) / law.channels();
    filters_.resize(covariance.rows(), directions);
    Eigen::Index kept = 0;
    for (int k = 0; k < directions; ++k) {
      Eigen::VectorXf normal(covariance.rows());
      fill_normal(stream, static_cast<std::uint64_t>(k), 0, {normal.data(), static_cast<std::size_t>(normal.size())});
      const Eigen::VectorXd direction = normal.cast<double>().normalized();
      const double of_projection = direction.dot(covariance * direction);
      if (of_projection < 1e-6 * variance) continue;
      filters_.col(kept++) = (direction / std::sqrt(of_projection)).cast<float>();
    }
    filters_.conservativeResize(Eigen::NoChange, kept);
  }

  static bool fits(Extent image, int side) { return std::min(image.width, image.height) >= side; }

  Eigen::Index directions() const { return filters_.cols(); }

  /// Sum of W2² over the directions; `u` has mean zero under the target.
  double distance(const Image& u) const {
    const Eigen::MatrixXf projected = patches(u) * filters_;
    FloatSorter z(means_.size());
    double total = 0;
    for (Eigen::Index k = 0; k < projected.cols(); ++k) {
      z.sort(projected.col(k).data());
      double sum = 0;
      for (std::size_t i = 0; i < means_.size(); ++i) sum += z[i] * (z[i] - 2 * means_[i]);
      total += 1 + sum / static_cast<double>(means_.size());
    }
    return total;
  }

 private:
  int positions(int length) const { return (length - side_) / spacing_ + 1; }
  std::int64_t count(Extent image) const { return std::int64_t{positions(image.width)} * positions(image.height); }

  /// One patch a row.
  Eigen::MatrixXf patches(const Image& u) const {
    const int across = positions(u.width()), down = positions(u.height());
    Eigen::MatrixXf result(static_cast<Eigen::Index>(means_.size()), filters_.rows());
    for (Eigen::Index entry = 0; entry < result.cols(); ++entry) {
      const auto e = static_cast<int>(entry);
      const int c = e / (side_ * side_), y = e / side_ % side_, x = e % side_;
      float* out = result.col(entry).data();
      for (int row = 0; row < down; ++row) {
        const float* in = u.row(c, row * spacing_ + y).data() + x;
        for (int i = 0; i < across; ++i) *out++ = in[std::ptrdiff_t{i} * spacing_];
      }
    }
    return result;
  }

  int side_;
  int spacing_;
  std::vector<double> means_;
  Eigen::MatrixXf filters_;  // one direction a column, divided by its target deviation
};

class PatchDistance : public SampleMetric {
 public:
  /// `law` is that of the samples' values less `mean`, up to longest_lag.
  PatchDistance(std::vector<double> mean, const LagWindow& law, const Domain& domain, Seed seed)
      : mean_(std::move(mean)) {
    if (!PatchLaw::fits(domain.size, sides.front())) {
      throw std::invalid_argument(fmt::format("samples of {}x{} pixels: expected at least {}x{} for patches",
                                              domain.size.width, domain.size.height, sides.front(), sides.front()));
    }
    constexpr int pairs = scales * static_cast<int>(sides.size());
    Extent image = domain.size;
    int pair = 0;
    for (std::vector<PatchLaw>& of_scale : laws_) {
      const int box = 1 << (&of_scale - laws_.data());
      for (const int side : sides) {
        const int directions = projections / pairs + (pair < projections % pairs ? 1 : 0);
        const Stream stream = Stream(seed).child("patch_distance").child(static_cast<std::uint64_t>(pair));
        ++pair;
        if (PatchLaw::fits(image, side)) of_scale.emplace_back(law, image, box, side, directions, stream);
      }
      image = {image.width / 2, image.height / 2};
    }
  }

  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    Image u = centered(sample, mean_, sample.extent());
    double sum = 0;
    Eigen::Index directions = 0;
    for (const std::vector<PatchLaw>& of_scale : laws_) {
      if (of_scale.empty()) break;
      if (&of_scale != laws_.data()) u = halved(u);
      for (const PatchLaw& law : of_scale) {
        sum += law.distance(u);
        directions += law.directions();
      }
    }
    return {static_cast<float>(sum / static_cast<double>(directions))};
  }

  double value(std::span<const double> mean) const override { return mean.front(); }

 private:
  std::vector<double> mean_;
  std::array<std::vector<PatchLaw>, scales> laws_;
};

}  // namespace

std::unique_ptr<SampleMetric> patch_distance(const Target& target, const Domain& domain, Seed seed) {
  return std::make_unique<PatchDistance>(target.gaussian.mean, LagWindow(target, domain, {longest_lag, longest_lag}),
                                         domain, seed);
}

std::unique_ptr<SampleMetric> limit_patch_distance(const Model& model, const Domain& domain, Seed seed) {
  const Gaussian* limit = model.gaussian();
  const SplineTexton* spline = model.spline_texton();
  const Texton* texton = spline != nullptr ? &spline->coefficients : model.texton();
  if (texton == nullptr || limit == nullptr) return nullptr;
  // The covariance of a B-spline of order n and its mirror image reaches n further than that of its coefficients.
  const int order = spline != nullptr ? spline->order : 0;
  const Extent reach{texton->extent().width + order, texton->extent().height + order};
  return std::make_unique<PatchDistance>(limit->mean(), LagWindow(*limit, reach, domain, {longest_lag, longest_lag}),
                                         domain, seed);
}

}  // namespace textonbench
