#include "experiments/metrics/modulus_and_phase.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "experiments/metrics/target_law.h"

namespace textonbench {
namespace {

void require_own_torus(const Target& target, const Domain& domain) {
  if (!on_own_torus(target, domain)) {
    throw std::invalid_argument(
        "modulus and phase are compared on the exemplar's own torus: expected a periodic "
        "domain of its size");
  }
}

/// One of each pair of bins that are complex conjugates, without those that are their own.
bool stands_for_a_pair(const Spectrum& spectrum, int kx, int ky) {
  return spectrum.multiplicity(kx) == 2 || (ky > 0 && 2 * ky < spectrum.rows());
}

class ModulusError : public SampleMetric {
 public:
  explicit ModulusError(const Target& target) : spot_(target.gaussian.spectrum.factors.front()) {}

  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    const GaussianModel model = gaussian_model(sample);
    const Spectrum& y = model.spectrum.factors.front();
    double largest_modulus = 0, largest_difference = 0;
    for (int c = 0; c < y.channels(); ++c) {
      for (int ky = 0; ky < y.rows(); ++ky) {
        for (int kx = 0; kx < y.columns(); ++kx) {
          const double wanted = std::abs(std::complex<double>(spot_.at(c, kx, ky)));
          const double found = std::abs(std::complex<double>(y.at(c, kx, ky)));
          largest_modulus = std::max(largest_modulus, wanted);
          largest_difference = std::max(largest_difference, std::fabs(found - wanted));
        }
      }
    }
    return {static_cast<float>(largest_difference / largest_modulus)};
  }
  double value(std::span<const double> mean) const override { return mean.front(); }

 private:
  const Spectrum& spot_;
};

/// Maps r(ξ) to a number that is uniform on [0, 1] under the law that is looked at.
using Uniformize = double (*)(std::complex<double>);

class KolmogorovSmirnov : public SampleMetric {
 public:
  KolmogorovSmirnov(const Target& target, Uniformize uniformize)
      : spot_(target.gaussian.spectrum.factors.front()),
        least_power_(1e-8 * color_covariance(target.gaussian.spectrum).trace()),
        uniformize_(uniformize) {}

  std::vector<float> statistic(const Image& sample, const Domain&) const override {
    const GaussianModel model = gaussian_model(sample);
    std::vector<double> values = uniformized(model.spectrum.factors.front());
    if (values.empty()) throw std::invalid_argument("the exemplar has no frequency off the self-conjugate ones");
    std::ranges::sort(values);
    const auto n = static_cast<double>(values.size());
    double distance = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto below = static_cast<double>(i);
      distance = std::max({distance, values[i] - below / n, (below + 1) / n - values[i]});
    }
    return {static_cast<float>(std::sqrt(n) * distance)};
  }
  double value(std::span<const double> mean) const override { return mean.front(); }

 private:
  std::vector<double> uniformized(const Spectrum& y) const {
    std::vector<double> values;
    for (int ky = 0; ky < y.rows(); ++ky) {
      for (int kx = 0; kx < y.columns(); ++kx) {
        if (!stands_for_a_pair(y, kx, ky)) continue;
        std::complex<double> overlap = 0;
        double power = 0;
        for (int c = 0; c < y.channels(); ++c) {
          const std::complex<double> t(spot_.at(c, kx, ky));
          overlap += std::conj(t) * std::complex<double>(y.at(c, kx, ky));
          power += std::norm(t);
        }
        if (power > least_power_) values.push_back(uniformize_(overlap / power));
      }
    }
    return values;
  }

  const Spectrum& spot_;
  double least_power_;
  Uniformize uniformize_;
};

}  // namespace

std::unique_ptr<SampleMetric> modulus_error(const Target& target, const Domain& domain, Seed) {
  require_own_torus(target, domain);
  return std::make_unique<ModulusError>(target);
}

std::unique_ptr<SampleMetric> rayleigh_distance(const Target& target, const Domain& domain, Seed) {
  require_own_torus(target, domain);
  return std::make_unique<KolmogorovSmirnov>(target, [](std::complex<double> r) { return -std::expm1(-std::norm(r)); });
}

std::unique_ptr<SampleMetric> phase_uniformity(const Target& target, const Domain& domain, Seed) {
  require_own_torus(target, domain);
  return std::make_unique<KolmogorovSmirnov>(
      target, [](std::complex<double> r) { return 0.5 + std::arg(r) / (2 * std::numbers::pi); });
}

}  // namespace textonbench
