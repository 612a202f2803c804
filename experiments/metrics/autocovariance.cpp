#include "experiments/metrics/autocovariance.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "experiments/metrics/target_law.h"

namespace textonbench {
namespace {

Extent within_half(Extent reach, Extent sample) {
  return {std::min(reach.width, (sample.width - 1) / 2), std::min(reach.height, (sample.height - 1) / 2)};
}

class AutocovarianceError : public SampleMetric {
 public:
  AutocovarianceError(const Target& target, const Domain& domain, Extent longest)
      : mean_(target.gaussian.mean), reach_(within_half(longest, domain.size)) {
    const LagWindow law(target, domain, reach_);
    for_each_entry(law.channels(), [&](int c, int d, int x, int y) { wanted_.push_back(law.at(c, d, x, y)); });
    for (std::size_t i = 0; i < wanted_.size(); ++i) energy_ += weight(i) * wanted_[i] * wanted_[i];
  }

  std::vector<float> statistic(const Image& sample, const Domain& domain) const override {
    const Extent torus = domain.periodic ? sample.extent()
                                         : Extent{good_fft_size(sample.width() + reach_.width),
                                                  good_fft_size(sample.height() + reach_.height)};
    const std::vector<Image> sums = lagged_products(forward_fft(centered(sample, mean_, torus)));
    const auto wrap = [](int v, int n) { return v < 0 ? v + n : v; };
    std::vector<float> result;
    result.reserve(wanted_.size());
    for_each_entry(sample.channels(), [&](int c, int d, int x, int y) {
      const bool stored = c <= d;
      const Image& of_pair = sums[static_cast<std::size_t>(std::max(c, d))];
      const float sum = stored ? of_pair.at(c, wrap(x, torus.width), wrap(y, torus.height))
                               : of_pair.at(d, wrap(-x, torus.width), wrap(-y, torus.height));
      const double products = domain.periodic ? static_cast<double>(torus.area())
                                              : static_cast<double>(sample.width() - std::abs(x)) *
                                                    static_cast<double>(sample.height() - std::abs(y));
      result.push_back(static_cast<float>(sum / products));
    });
    return result;
  }

  double value(std::span<const double> estimate) const override {
    double squares = 0;
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      const double difference = estimate[i] - wanted_[i];
      squares += weight(i) * difference * difference;
    }
    return std::sqrt(squares / energy_);
  }

 private:
  /// Calls visit(c, d, x, y) for the lags of one half plane, lag zero first.
  template <class Visit>
  void for_each_entry(int channels, const Visit& visit) const {
    for (int y = 0; y <= reach_.height; ++y) {
      for (int x = y == 0 ? 0 : -reach_.width; x <= reach_.width; ++x) {
        for (int c = 0; c < channels; ++c) {
          for (int d = 0; d < channels; ++d) visit(c, d, x, y);
        }
      }
    }
  }

  /// How many lags an entry stands for: v and −v, but for v = 0.
  double weight(std::size_t entry) const { return entry < mean_.size() * mean_.size() ? 1 : 2; }

  /// Σ_x u_c(x + v) u_d(x) on the torus for all pairs c <= d: channel c of image d.
  static std::vector<Image> lagged_products(const Spectrum& u) {
    std::vector<Image> sums;
    sums.reserve(static_cast<std::size_t>(u.channels()));
    for (int d = 0; d < u.channels(); ++d) {
      Spectrum products(u.raster(), d + 1);
      for (int c = 0; c <= d; ++c) {
        for (int ky = 0; ky < u.rows(); ++ky) {
          const auto a = u.row(c, ky);
          const auto b = u.row(d, ky);
          const auto out = products.row(c, ky);
          for (std::size_t kx = 0; kx < out.size(); ++kx) {
            const float ar = a[kx].real(), ai = a[kx].imag(), br = b[kx].real(), bi = b[kx].imag();
            out[kx] = {ar * br + ai * bi, ai * br - ar * bi};
          }
        }
      }
      sums.push_back(inverse_fft(products));
    }
    return sums;
  }

  std::vector<double> mean_;
  Extent reach_;
  std::vector<double> wanted_;
  double energy_ = 0;
};

}  // namespace

std::unique_ptr<SampleMetric> autocovariance_error_8(const Target& target, const Domain& domain, Seed) {
  return std::make_unique<AutocovarianceError>(target, domain, Extent{8, 8});
}

std::unique_ptr<SampleMetric> autocovariance_error_32(const Target& target, const Domain& domain, Seed) {
  return std::make_unique<AutocovarianceError>(target, domain, Extent{32, 32});
}

std::unique_ptr<SampleMetric> autocovariance_error_quarter(const Target& target, const Domain& domain, Seed) {
  return std::make_unique<AutocovarianceError>(target, domain, Extent{domain.size.width / 4, domain.size.height / 4});
}

std::unique_ptr<SampleMetric> circular_autocovariance_error(const Target& target, const Domain& domain, Seed) {
  GaussianModel raw = gaussian_model(target.exemplar.pixels);
  Autocovariance covariance = autocovariance(raw.spectrum);
  const Target as_it_is{target.exemplar, target.exemplar.pixels, std::move(raw), std::move(covariance)};
  return std::make_unique<AutocovarianceError>(as_it_is, domain, Extent{32, 32});
}

}  // namespace textonbench
