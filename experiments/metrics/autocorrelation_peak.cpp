#include "experiments/metrics/autocorrelation_peak.h"

#include <algorithm>
#include <cmath>

#include "methods/base/mask.h"

namespace textonbench {
namespace {

constexpr int least_lag = 4;

class PeakError final : public SampleMetric {
 public:
  PeakError(const Target& target, const Domain& domain) : mean_(target.gaussian.mean) {
    const Extent size = target.exemplar.pixels.extent();
    const int reach = std::min({size.width, size.height, domain.size.width, domain.size.height}) / 3;
    const auto rho = [&](int x, int y) {
      double sum = 0, variance = 0;
      for (int c = 0; c < target.exemplar.pixels.channels(); ++c) {
        sum += target.covariance.at(c, c, x, y);
        variance += target.covariance.at(c, c, 0, 0);
      }
      return sum / variance;
    };
    for (int y = 0; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const int squared = x * x + y * y;
        if (squared < least_lag * least_lag || squared > reach * reach) continue;
        const double here = rho(x, y);
        if (here <= rho_) continue;
        bool highest = true;
        for (int k = 0; k < 9; ++k) {
          const int dx = k % 3 - 1, dy = k / 3 - 1;
          highest = highest && (k == 4 || rho(x + dx, y + dy) < here);
        }
        if (highest) rho_ = here, lag_ = {x, y};
      }
    }
  }

  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    double products = 0, squares = 0;
    const int left = std::max(0, -lag_.x), right = sample.width() - std::max(0, lag_.x);
    for (int c = 0; c < sample.channels(); ++c) {
      const double mean = mean_[static_cast<std::size_t>(c)];
      for (int y = 0; y + lag_.y < sample.height(); ++y) {
        const auto here = sample.row(c, y), there = sample.row(c, y + lag_.y);
        for (int x = left; x < right; ++x) {
          const double a = static_cast<double>(here[static_cast<std::size_t>(x)]) - mean;
          const double b =
              static_cast<double>(there[static_cast<std::size_t>(x) + static_cast<std::size_t>(lag_.x)]) - mean;
          products += a * b;
          squares += (a * a + b * b) / 2;
        }
      }
    }
    return {static_cast<float>(products), static_cast<float>(squares)};
  }

  double value(std::span<const double> mean_statistic) const override {
    return rho_ > 0 ? std::abs(mean_statistic[0] / mean_statistic[1] - rho_) : 0;
  }

 private:
  std::vector<double> mean_;
  double rho_ = 0;
  Pixel lag_{};
};

}  // namespace

std::unique_ptr<SampleMetric> autocorrelation_peak_error(const Target& target, const Domain& domain, Seed) {
  return std::make_unique<PeakError>(target, domain);
}

}  // namespace textonbench
