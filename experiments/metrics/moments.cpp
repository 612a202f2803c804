#include "experiments/metrics/moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "experiments/metrics/target_law.h"

namespace textonbench {
namespace {

/// Standardizes channel by channel; a `deviation` of zero marks a channel to leave out.
struct Marginals {
  std::vector<double> mean, deviation;

  /// Power means of orders 1 … `orders` of each channel that is looked at.
  std::vector<float> power_means(const Image& sample, int orders) const {
    std::vector<float> result;
    for (int c = 0; c < sample.channels(); ++c) {
      const double m = mean[static_cast<std::size_t>(c)];
      const double sd = deviation[static_cast<std::size_t>(c)];
      if (sd == 0) continue;
      std::array<double, 4> sums{};
      for (int y = 0; y < sample.height(); ++y) {
        std::array<double, 4> row{};
        for (const float value : sample.row(c, y)) {
          const double z = (value - m) / sd;
          row[0] += z;
          row[1] += z * z;
          row[2] += z * z * z;
          row[3] += z * z * z * z;
        }
        for (std::size_t j = 0; j < row.size(); ++j) sums[j] += row[j];
      }
      for (int j = 0; j < orders; ++j) {
        result.push_back(
            static_cast<float>(sums[static_cast<std::size_t>(j)] / static_cast<double>(sample.extent().area())));
      }
    }
    return result;
  }
};

class MeanError : public SampleMetric {
 public:
  explicit MeanError(Marginals marginals) : marginals_(std::move(marginals)) {}
  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    return marginals_.power_means(sample, 1);
  }
  double value(std::span<const double> mean) const override {
    double squares = 0;
    for (const double m : mean) squares += m * m;
    return std::sqrt(squares / static_cast<double>(mean.size()));
  }

 private:
  Marginals marginals_;
};

class StandardizedMoment : public SampleMetric {
 public:
  /// `shape` maps the central moments of orders 2, 3 and 4 to the number.
  using Shape = double (*)(double, double, double);
  StandardizedMoment(Marginals marginals, Shape shape) : marginals_(std::move(marginals)), shape_(shape) {}
  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    return marginals_.power_means(sample, 4);
  }
  double value(std::span<const double> mean) const override {
    const std::size_t channels = mean.size() / 4;
    double sum = 0;
    for (std::size_t i = 0; i < 4 * channels; i += 4) {
      const double m1 = mean[i], m2 = mean[i + 1], m3 = mean[i + 2], m4 = mean[i + 3];
      const double central2 = m2 - m1 * m1;
      const double central3 = m3 - 3 * m1 * m2 + 2 * m1 * m1 * m1;
      const double central4 = m4 - 4 * m1 * m3 + 6 * m1 * m1 * m2 - 3 * m1 * m1 * m1 * m1;
      // The power means are rounded to float32, so no smaller variance can be told from none.
      if (central2 <= 1e-6 * m2 || m2 <= 1e-12) {
        throw std::invalid_argument(fmt::format(
            "samples have a standardized variance of {:.3g} in a channel: expected samples that vary", central2));
      }
      sum += shape_(central2, central3, central4);
    }
    return sum / static_cast<double>(channels);
  }

 private:
  Marginals marginals_;
  Shape shape_;
};

}  // namespace

std::unique_ptr<SampleMetric> mean_error(const Target& target, const Domain&, Seed) {
  std::vector<double> units = channel_deviations(target);
  const double largest = *std::ranges::max_element(units);
  std::ranges::replace(units, 0.0, largest);
  return std::make_unique<MeanError>(Marginals{target.gaussian.mean, std::move(units)});
}

std::unique_ptr<SampleMetric> skewness(const Target& target, const Domain&, Seed) {
  return std::make_unique<StandardizedMoment>(Marginals{target.gaussian.mean, channel_deviations(target)},
                                              [](double m2, double m3, double) { return m3 / (m2 * std::sqrt(m2)); });
}

std::unique_ptr<SampleMetric> excess_kurtosis(const Target& target, const Domain&, Seed) {
  return std::make_unique<StandardizedMoment>(Marginals{target.gaussian.mean, channel_deviations(target)},
                                              [](double m2, double, double m4) { return m4 / (m2 * m2) - 3; });
}

}  // namespace textonbench
