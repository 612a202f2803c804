#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "experiments/metrics/metric.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

void require_measurable(const Image& sample, std::size_t index, const Domain& domain) {
  if (sample.extent() != domain.size) {
    throw std::invalid_argument(fmt::format("sample {} is of {}x{} pixels: expected {}x{}, the domain's size",
                                            index + 1, sample.width(), sample.height(), domain.size.width,
                                            domain.size.height));
  }
  if (const auto bad = find_non_finite(sample)) {
    throw std::invalid_argument(fmt::format("sample {} holds {} at channel {}, pixel ({}, {}): expected finite values",
                                            index + 1, sample.at(bad->channel, bad->x, bad->y), bad->channel, bad->x,
                                            bad->y));
  }
}

}  // namespace

MetricValue measure_samples(const SampleMetric& metric, std::span<const Image> samples, const Domain& domain) {
  if (samples.empty()) throw std::invalid_argument("no samples to measure: expected at least one");
  std::vector<std::vector<float>> statistics(samples.size());
  parallel_for(static_cast<int>(samples.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    require_measurable(samples[index], index, domain);
    statistics[index] = metric.statistic(samples[index], domain);
  });

  const std::size_t size = statistics.front().size();
  std::vector<double> sum(size);
  for (const std::vector<float>& statistic : statistics) {
    for (std::size_t j = 0; j < size; ++j) sum[j] += statistic[j];
  }
  std::vector<double> mean(size);
  const auto count = static_cast<double>(samples.size());
  for (std::size_t j = 0; j < size; ++j) mean[j] = sum[j] / count;
  MetricValue result{.value = metric.value(mean), .stderr_value = {}, .floor = {}};
  if (samples.size() < 2) return result;

  std::vector<double> values;
  values.reserve(samples.size());
  double mean_value = 0;
  for (const std::vector<float>& left_out : statistics) {
    for (std::size_t j = 0; j < size; ++j) mean[j] = (sum[j] - left_out[j]) / (count - 1);
    values.push_back(metric.value(mean));
    mean_value += values.back() / count;
  }
  double squares = 0;
  for (const double value : values) squares += (value - mean_value) * (value - mean_value);
  result.stderr_value = std::sqrt((count - 1) / count * squares);
  return result;
}

}  // namespace textonbench
