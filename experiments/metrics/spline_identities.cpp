#include "experiments/metrics/spline_identities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "experiments/metrics/replicates.h"
#include "experiments/metrics/spline_law.h"
#include "experiments/metrics/spot_samples.h"
#include "methods/base/spectrum.h"
#include "methods/spot/texton_noise.h"

namespace textonbench {
namespace {

constexpr int spline_samples = 256;
constexpr int spline_reach = 36;
constexpr Domain spline_window{.size = {64, 64}};

/// The autocorrelation of the tent (1 − |x|)₊ at a whole lag by Simpson's rule between the knots, exact for cubics.
double tent_correlation(int lag) {
  const auto tent = [](double x) { return std::max(0.0, 1 - std::fabs(x)); };
  double sum = 0;
  for (int left = -1; left < 1; ++left) {
    for (const auto& [t, weight] : {std::pair{0.0, 1.0}, std::pair{0.5, 4.0}, std::pair{1.0, 1.0}}) {
      sum += weight / 6 * tent(left + t) * tent(left + t + lag);
    }
  }
  return sum;
}

std::unique_ptr<Model> noise_of(const SplineTexton& texton, ImpactProcess impacts) {
  return make_spline_noise(texton, {.impacts = impacts, .mni = 30});
}

Seed sample_seed(const Target& target, std::string_view metric, int sample) {
  return derive(derive(derive(Seed{1}, metric), target.exemplar.name), static_cast<std::uint64_t>(sample));
}

Image centered_sample(const Model& noise, const Domain& domain, Seed seed, std::span<const double> mean) {
  Image sample = noise.synthesize(domain, seed);
  for (int c = 0; c < sample.channels(); ++c) {
    const auto m = static_cast<float>(mean[static_cast<std::size_t>(c)]);
    for (int y = 0; y < sample.height(); ++y) {
      for (float& value : sample.row(c, y)) value -= m;
    }
  }
  return sample;
}

/// Channel by channel, each in the order of for_each_lag, at multiples of `step`.
std::vector<double> expected_covariance(const SplineTexton& texton, int reach, double step) {
  const SplineCovariance covariance(texton);
  std::vector<double> expected;
  for (int c = 0; c < covariance.channels(); ++c) {
    for_each_lag(reach, [&](int x, int y) { expected.push_back(covariance.at(c, step * x, step * y)); });
  }
  return expected;
}

/// Of the covariance on all of the domains, whose samples are independent, at up to `reach` of their steps.
double covariance_deviation(const SplineTexton& texton, ImpactProcess impacts, std::span<const Domain> domains,
                            int reach, const Target& target, std::string_view metric) {
  const std::unique_ptr<Model> noise = noise_of(texton, impacts);
  const auto grids = static_cast<int>(domains.size());
  const Replicates replicates = draw_replicates(spline_samples, [&](int i) {
    std::vector<float> products;
    for (int g = 0; g < grids; ++g) {
      const Image sample = centered_sample(*noise, domains[static_cast<std::size_t>(g)],
                                           sample_seed(target, metric, grids * i + g), texton.coefficients.mean);
      const std::vector<float> more = lag_products(sample, reach);
      products.insert(products.end(), more.begin(), more.end());
    }
    return products;
  });
  const std::vector<double> once = expected_covariance(texton, reach, domains.front().step);
  std::vector<double> expected;
  for (int g = 0; g < grids; ++g) expected.insert(expected.end(), once.begin(), once.end());
  return largest_deviation(replicates, expected);
}

}  // namespace

std::optional<double> bilinear_autocorrelation_error(const Model&, const Target&, const Domain&) {
  const auto stated = [](int lag) { return lag == 0 ? 2.0 / 3 : std::abs(lag) == 1 ? 1.0 / 6 : 0; };
  double error = 0;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      error = std::max(error, std::fabs(tent_correlation(x) * tent_correlation(y) - stated(x) * stated(y)));
    }
  }
  return error;
}

std::optional<double> bilinear_power_least(const Model&, const Target&, const Domain&) {
  constexpr int grid = 64;
  double least = 1;
  for (int ky = 0; ky < grid; ++ky) {
    for (int kx = 0; kx < grid; ++kx) {
      double power = 0;
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
          power += tent_correlation(x) * tent_correlation(y) *
                   std::cos(2 * std::numbers::pi * (kx * x + ky * y) / static_cast<double>(grid));
        }
      }
      least = std::min(least, power);
    }
  }
  return least;
}

std::optional<double> shifted_covariance_deviation(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  std::array<Domain, 3> domains{};
  domains.fill(spline_window);
  domains[1].origin = {0.25, 0.25};
  domains[2].origin = {0.5, 0.5};
  return covariance_deviation(*texton, ImpactProcess::poisson, domains, spline_reach, target,
                              "shifted_covariance_deviation");
}

std::optional<double> subpixel_covariance_deviation(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const std::array domains{Domain{.size = {64, 64}, .step = 0.25}};
  return covariance_deviation(*texton, ImpactProcess::poisson, domains, 12, target, "subpixel_covariance_deviation");
}

std::optional<double> signed_mean_deviation(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const std::unique_ptr<Model> noise = noise_of(*texton, ImpactProcess::signed_poisson);
  const Replicates means = draw_replicates(spline_samples, [&](int i) {
    const std::vector<double> mean =
        channel_means(noise->synthesize(spline_window, sample_seed(target, "signed_mean_deviation", i)));
    return std::vector<float>(mean.begin(), mean.end());
  });
  return largest_deviation(means, texton->coefficients.mean);
}

std::optional<double> signed_covariance_deviation(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  return covariance_deviation(*texton, ImpactProcess::signed_poisson, std::array{spline_window}, spline_reach, target,
                              "signed_covariance_deviation");
}

std::optional<double> kept_channel_variance(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const SplineCovariance covariance(*texton);
  double largest = 0;
  for (int c = 0; c < covariance.channels(); ++c) {
    largest = std::max(largest, covariance.at(c, 0, 0) / target.covariance.at(c, c, 0, 0));
  }
  return largest;
}

std::optional<double> order_zero_difference(const Model&, const Target& target, const Domain&) {
  constexpr int side = 31;
  const Extent extent = target.exemplar.pixels.extent();
  if (std::min(extent.width, extent.height) < side) return std::nullopt;
  const Support support = square_support(side);
  const Image nearest = fit_texton_noise(target.exemplar, support, {.order = 0}, Seed{1}).coefficients.kernels.front();
  const Image discrete = fit_sot(target.exemplar, support, {}, Seed{1}).texton.kernels.front();
  double difference = 0, largest = 0;
  for (int c = 0; c < discrete.channels(); ++c) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const double value = discrete.at(c, x, y);
        difference = std::max(difference, std::fabs(value - nearest.at(c, x, y)));
        largest = std::max(largest, std::fabs(value));
      }
    }
  }
  return difference / largest;
}

}  // namespace textonbench
