#include "experiments/metrics/spot_identities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "experiments/metrics/replicates.h"
#include "experiments/metrics/spot_samples.h"
#include "experiments/metrics/texton_quality.h"
#include "methods/base/spectrum.h"
#include "methods/spot/impacts.h"
#include "methods/spot/support.h"

namespace textonbench {
namespace {

constexpr int replicate_count = 256;
constexpr double usual_impacts = 30;
constexpr std::array few_to_many_impacts{5.0, 30.0, 100.0};

double power_sum(const Image& kernel, int channel, int power) {
  double sum = 0;
  for (int y = 0; y < kernel.height(); ++y) {
    for (const float value : kernel.row(channel, y)) sum += std::pow(static_cast<double>(value), power);
  }
  return sum;
}

/// Null unless the model sums one kernel, zero in no channel, at points that are drawn one by one.
const Texton* sparse_texton(const Model& model) {
  const Texton* texton = model.texton();
  if (texton == nullptr || texton->kernels.size() != 1) return nullptr;
  for (int c = 0; c < texton->channels(); ++c) {
    if (power_sum(texton->kernels.front(), c, 2) == 0) return nullptr;
  }
  const double densest = few_to_many_impacts.back() / static_cast<double>(texton->support_pixels);
  return densest < dense_intensity ? texton : nullptr;
}

double intensity_of(const Texton& texton, double mni) { return mni / static_cast<double>(texton.support_pixels); }

Stream points(const Target& target, std::string_view metric) {
  return Stream(Seed{1}).child(metric).child(target.exemplar.name);
}

/// λ Σ h of each channel.
std::vector<double> mean_of_noise(const Image& kernel, double intensity) {
  std::vector<double> mean;
  mean.reserve(static_cast<std::size_t>(kernel.channels()));
  for (int c = 0; c < kernel.channels(); ++c) mean.push_back(intensity * power_sum(kernel, c, 1));
  return mean;
}

Image less_its_mean(Image noise, std::span<const double> mean) {
  for (int c = 0; c < noise.channels(); ++c) {
    const auto m = static_cast<float>(mean[static_cast<std::size_t>(c)]);
    for (int y = 0; y < noise.height(); ++y) {
      for (float& value : noise.row(c, y)) value -= m;
    }
  }
  return noise;
}

/// Longer side of the box of the support, minus one pixel: 2r of a disc of radius r.
int diameter(const Support& support) { return std::max(support.box.width, support.box.height) - 1; }

/// A statistic of `count` samples of the noise, one of each child of the stream.
template <class Statistic>
Replicates replicate_noise(const Image& kernel, double intensity, const Stream& stream, Extent window, int count,
                           const Statistic& statistic) {
  return draw_replicates(count, [&](int i) {
    return statistic(raw_spot_noise(kernel, intensity, stream.child(static_cast<std::uint64_t>(i)), window));
  });
}

/// Appends to each replicate what the other says.
void append(Replicates& replicates, const Replicates& more) {
  replicates.resize(more.size());
  for (std::size_t i = 0; i < more.size(); ++i) {
    replicates[i].insert(replicates[i].end(), more[i].begin(), more[i].end());
  }
}

/// Multiples of 1 / sd at which the characteristic function is taken.
constexpr std::array frequencies{0.5, 1.0, 2.0};

/// F, (F − mean)², cos and sin of tF.
std::vector<float> campbell_statistic(const Image& noise, std::span<const double> mean, std::span<const double> sd) {
  std::vector<float> result;
  for (int c = 0; c < noise.channels(); ++c) {
    const auto channel = static_cast<std::size_t>(c);
    const double value = noise.at(c, 0, 0);
    result.insert(result.end(), {static_cast<float>(value), static_cast<float>(std::pow(value - mean[channel], 2))});
    for (const double frequency : frequencies) {
      const double turn = frequency / sd[channel] * value;
      result.insert(result.end(), {static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn))});
    }
  }
  return result;
}

std::vector<double> campbell_expectation(const Image& kernel, double intensity, std::span<const double> mean,
                                         std::span<const double> sd) {
  std::vector<double> result;
  for (int c = 0; c < kernel.channels(); ++c) {
    const auto channel = static_cast<std::size_t>(c);
    result.insert(result.end(), {mean[channel], sd[channel] * sd[channel]});
    for (const double frequency : frequencies) {
      std::complex<double> exponent = 0;
      for (int y = 0; y < kernel.height(); ++y) {
        for (const float value : kernel.row(c, y)) exponent += std::polar(1.0, frequency / sd[channel] * value) - 1.0;
      }
      const std::complex<double> characteristic = std::exp(intensity * exponent);
      result.insert(result.end(), {characteristic.real(), characteristic.imag()});
    }
  }
  return result;
}

}  // namespace

std::optional<double> impact_mean_deviation(const Model& model, const Target& target, const Domain&) {
  const Texton* texton = sparse_texton(model);
  if (texton == nullptr) return std::nullopt;
  const Image& kernel = texton->kernels.front();
  Replicates replicates;
  std::vector<double> expected;
  for (const double mni : few_to_many_impacts) {
    const double intensity = intensity_of(*texton, mni);
    const Stream stream = points(target, "impact_mean_deviation").child(static_cast<std::uint64_t>(mni));
    append(replicates, replicate_noise(kernel, intensity, stream, {64, 64}, replicate_count, [](const Image& noise) {
             const std::vector<double> means = channel_means(noise);
             return std::vector<float>(means.begin(), means.end());
           }));
    for (const double mean : mean_of_noise(kernel, intensity)) expected.push_back(mean);
  }
  return largest_deviation(replicates, expected);
}

std::optional<double> impact_covariance_deviation(const Model& model, const Target& target, const Domain&) {
  const Texton* texton = sparse_texton(model);
  if (texton == nullptr) return std::nullopt;
  constexpr int reach = 40;
  const Image& kernel = texton->kernels.front();
  std::vector<double> correlation;
  for (int c = 0; c < kernel.channels(); ++c) {
    for_each_lag(reach, [&](int x, int y) { correlation.push_back(autocorrelation(kernel, c, x, y)); });
  }
  Replicates replicates;
  std::vector<double> expected;
  for (const double mni : few_to_many_impacts) {
    const double intensity = intensity_of(*texton, mni);
    const std::vector<double> mean = mean_of_noise(kernel, intensity);
    const Stream stream = points(target, "impact_covariance_deviation").child(static_cast<std::uint64_t>(mni));
    append(replicates, replicate_noise(kernel, intensity, stream, {96, 96}, replicate_count, [&](Image noise) {
             return lag_products(less_its_mean(std::move(noise), mean), reach);
           }));
    for (const double value : correlation) expected.push_back(intensity * value);
  }
  return largest_deviation(replicates, expected);
}

std::optional<double> impacts_on_pixel_ratio(const Model& model, const Target& target, const Domain&) {
  const Texton* texton = sparse_texton(model);
  if (texton == nullptr) return std::nullopt;
  const Replicates counts =
      replicate_noise(support_mask(*texton), intensity_of(*texton, usual_impacts),
                      points(target, "impacts_on_pixel_ratio"), {64, 64}, replicate_count,
                      [](const Image& noise) { return std::vector{static_cast<float>(channel_means(noise).front())}; });
  double sum = 0;
  for (const std::vector<float>& count : counts) sum += count.front();
  return sum / replicate_count / usual_impacts;
}

std::optional<double> campbell_deviation(const Model& model, const Target& target, const Domain&) {
  const Texton* texton = sparse_texton(model);
  if (texton == nullptr) return std::nullopt;
  constexpr int values = 4096;
  const Image& kernel = texton->kernels.front();
  Replicates replicates;
  std::vector<double> expected;
  for (const double mni : {few_to_many_impacts[0], few_to_many_impacts[1]}) {
    const double intensity = intensity_of(*texton, mni);
    const std::vector<double> mean = mean_of_noise(kernel, intensity);
    std::vector<double> sd;
    sd.reserve(mean.size());
    for (int c = 0; c < kernel.channels(); ++c) sd.push_back(std::sqrt(intensity * power_sum(kernel, c, 2)));
    const Stream stream = points(target, "campbell_deviation").child(static_cast<std::uint64_t>(mni));
    append(replicates, replicate_noise(kernel, intensity, stream, {1, 1}, values,
                                       [&](const Image& noise) { return campbell_statistic(noise, mean, sd); }));
    for (const double value : campbell_expectation(kernel, intensity, mean, sd)) expected.push_back(value);
  }
  return largest_deviation(replicates, expected);
}

std::optional<double> dependence_reach(const Model& model, const Target&, const Domain&) {
  if (model.texton() == nullptr) return std::nullopt;
  const Support support = mask_support(support_mask(*model.texton()));
  const std::vector<SupportRun> runs = support_runs(support);
  double farthest = 0;
  for (const SupportRun& a : runs) {
    for (const SupportRun& b : runs) farthest = std::max(farthest, std::hypot(a.last - 1 - b.first, a.y - b.y));
  }
  return farthest / diameter(support);
}

std::optional<double> distant_dependence(const Model& model, const Target& target, const Domain&) {
  const Texton* texton = sparse_texton(model);
  if (texton == nullptr) return std::nullopt;
  const Image& kernel = texton->kernels.front();
  const int apart = diameter(mask_support(support_mask(*texton)));
  const int reach = apart + 8;
  const double intensity = intensity_of(*texton, usual_impacts);
  const std::vector<double> mean = mean_of_noise(kernel, intensity);
  std::vector<std::size_t> distant;
  std::size_t entry = 0;
  for (int c = 0; c < kernel.channels(); ++c) {
    for_each_lag(reach, [&](int x, int y) {
      if (x * x + y * y > apart * apart) distant.push_back(entry);
      ++entry;
    });
  }
  const auto statistic = [&](Image noise) {
    Image field = less_its_mean(std::move(noise), mean);
    std::vector<float> result;
    result.reserve(2 * distant.size());
    const auto add_products = [&] {
      const std::vector<float> products = lag_products(field, reach);
      for (const std::size_t i : distant) result.push_back(products[i]);
    };
    add_products();
    for (int c = 0; c < field.channels(); ++c) {
      const auto variance = static_cast<float>(intensity * power_sum(kernel, c, 2));
      for (int y = 0; y < field.height(); ++y) {
        for (float& value : field.row(c, y)) value = value * value - variance;
      }
    }
    add_products();
    return result;
  };
  const Replicates replicates = replicate_noise(kernel, intensity, points(target, "distant_dependence"),
                                                {2 * reach, 2 * reach}, replicate_count, statistic);
  return largest_deviation(replicates, std::vector<double>(2 * distant.size()));
}

}  // namespace textonbench
