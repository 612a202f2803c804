#include "experiments/metrics/cramer_von_mises.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "experiments/metrics/target_law.h"

namespace textonbench {
namespace {

/// Distribution function of N(0, 1).
double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double cramer_von_mises_statistic(std::vector<double>& z) {
  std::ranges::sort(z);
  const auto n = static_cast<double>(z.size());
  double sum = 1 / (12 * n);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double difference = normal_cdf(z[i]) - (static_cast<double>(i) + 0.5) / n;
    sum += difference * difference;
  }
  return sum;
}

/// max |Γ(v)| over the lags v of the torus with max(|v_x|, |v_y|) = r, for r = 0 … half of the longer side.
std::vector<double> largest_by_ring(const std::vector<double>& covariance, Extent grid) {
  std::vector<double> largest(static_cast<std::size_t>(std::max(grid.width, grid.height) / 2 + 1));
  std::size_t next = 0;
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const int radius = std::max(std::min(x, grid.width - x), std::min(y, grid.height - y));
      double& of_ring = largest[static_cast<std::size_t>(radius)];
      of_ring = std::max(of_ring, std::abs(covariance[next++]));
    }
  }
  return largest;
}

class CramerVonMises : public SampleMetric {
 public:
  CramerVonMises(const Target& target, const Domain& domain, Seed seed)
      : mean_(target.gaussian.mean), deviation_(channel_deviations(target)) {
    require_unit_step(domain);
    const int spacing = decorrelation_length(target);
    RandomSequence random(Stream(seed).child("cramer_von_mises"));
    columns_ = grid_positions(domain.size.width, spacing, random);
    rows_ = grid_positions(domain.size.height, spacing, random);
  }

  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    double sum = 0;
    int channels = 0;
    for (int c = 0; c < sample.channels(); ++c) {
      const auto channel = static_cast<std::size_t>(c);
      if (deviation_[channel] == 0) continue;
      std::vector<double> z;
      for (const int y : rows_) {
        for (const int x : columns_) z.push_back((sample.at(c, x, y) - mean_[channel]) / deviation_[channel]);
      }
      sum += cramer_von_mises_statistic(z);
      ++channels;
    }
    return {static_cast<float>(sum / channels)};
  }

  double value(std::span<const double> mean) const override { return mean.front(); }

 private:
  /// As many positions in [0, side) as fit on a circle of that length.
  static std::vector<int> grid_positions(int side, int spacing, RandomSequence& random) {
    const int step = std::min(side, spacing);
    const auto offset = static_cast<int>(random.below(static_cast<std::uint64_t>(step)));
    std::vector<int> positions(static_cast<std::size_t>(side / step));
    std::ranges::generate(positions, [next = offset, step]() mutable { return std::exchange(next, next + step); });
    return positions;
  }

  std::vector<double> mean_, deviation_;
  std::vector<int> columns_, rows_;
};

}  // namespace

int decorrelation_length(const Target& target) {
  const Autocovariance& covariance = target.covariance;
  const std::vector<double> deviation = channel_deviations(target);
  int length = 1;
  for (std::size_t channel = 0; channel < deviation.size(); ++channel) {
    const double sd = deviation[channel];
    if (sd == 0) continue;
    const std::vector<double> largest =
        largest_by_ring(covariance.planes[channel * deviation.size() + channel], covariance.grid);
    const auto first = std::ranges::find_if(largest, [&](double value) { return value < 0.1 * sd * sd; });
    length = std::max(length, static_cast<int>(first - largest.begin()));
  }
  return length;
}

std::unique_ptr<SampleMetric> cramer_von_mises(const Target& target, const Domain& domain, Seed seed) {
  return std::make_unique<CramerVonMises>(target, domain, seed);
}

}  // namespace textonbench
