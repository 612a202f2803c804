#include "experiments/metrics/color_covariance.h"

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "experiments/metrics/target_law.h"

namespace textonbench {
namespace {

double inner_product(std::span<const float> a, std::span<const float> b) {
  double sum = 0;
  for (std::size_t x = 0; x < a.size(); ++x) sum += static_cast<double>(a[x]) * b[x];
  return sum;
}

class ColorCovarianceError : public SampleMetric {
 public:
  explicit ColorCovarianceError(const Target& target)
      : mean_(target.gaussian.mean), wanted_(color_covariance(target.gaussian.spectrum)) {}

  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    const Image u = centered(sample, mean_, sample.extent());
    const auto area = static_cast<double>(u.extent().area());
    std::vector<float> moments;
    for (int c = 0; c < u.channels(); ++c) {
      double sum = 0;
      for (int y = 0; y < u.height(); ++y) {
        for (const float value : u.row(c, y)) sum += value;
      }
      moments.push_back(static_cast<float>(sum / area));
    }
    for (int c = 0; c < u.channels(); ++c) {
      for (int d = 0; d <= c; ++d) {
        double sum = 0;
        for (int y = 0; y < u.height(); ++y) sum += inner_product(u.row(c, y), u.row(d, y));
        moments.push_back(static_cast<float>(sum / area));
      }
    }
    return moments;
  }

  double value(std::span<const double> moments) const override {
    const Eigen::Index channels = wanted_.rows();
    const Eigen::Map<const Eigen::VectorXd> mean(moments.data(), channels);
    Eigen::MatrixXd covariance(channels, channels);
    std::size_t next = static_cast<std::size_t>(channels);
    for (Eigen::Index c = 0; c < channels; ++c) {
      for (Eigen::Index d = 0; d <= c; ++d) {
        covariance(c, d) = covariance(d, c) = moments[next++] - mean(c) * mean(d);
      }
    }
    return std::sqrt(bures_distance_squared(covariance, wanted_) / wanted_.trace());
  }

 private:
  std::vector<double> mean_;
  Eigen::MatrixXd wanted_;
};

}  // namespace

std::unique_ptr<SampleMetric> color_covariance_error(const Target& target, const Domain&, Seed) {
  return std::make_unique<ColorCovarianceError>(target);
}

}  // namespace textonbench
