// What is measured on a model and its samples. One file a metric (or a family that shares its computation); the list
// is in catalog.cpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "methods/method.h"

namespace textonbench {

/// What samples are held against: the Gaussian law of the exemplar's periodic component.
struct Target {
  const Exemplar& exemplar;
  Image periodic_component;
  GaussianModel gaussian;     ///< of periodic_component
  Autocovariance covariance;  ///< of `gaussian`
};
Target make_target(const Exemplar& exemplar);
Target make_target(Exemplar&&) = delete;  // it would outlive its exemplar

/// A number with its standard error over seeds and the value that samples of the exact Gaussian law would score.
struct MetricValue {
  double value = 0;
  std::optional<double> stderr_value;
  std::optional<double> floor;
};

/// A sample-level metric in two halves. `statistic` maps one sample to a vector; `value` maps the mean of those vectors
/// over seeds to the number. The standard error is the jackknife over seeds, and the floor is the same computation on
/// as many samples of the target's own Gaussian law; neither is the metric's business.
class SampleMetric {
 public:
  virtual ~SampleMetric() = default;
  virtual std::vector<float> statistic(const Image& sample, const Domain& domain) const = 0;
  virtual double value(std::span<const double> mean_statistic) const = 0;
};

/// frame: of samples that a graphics processor draws (experiments/gpu_run.h).
enum class MetricLevel { model, sample, cost, frame };
enum class Better { lower, higher, nearer_zero, neither };

struct MetricEntry {
  std::string_view name;   ///< "autocovariance_error_8"
  std::string_view title;  ///< "Autocovariance error, lags up to 8"
  std::string_view unit;   ///< "1" for a ratio, "s", "dB", …
  MetricLevel level;
  Better better;
  std::string_view reference;  ///< definition: paper and equation, or a formula
  std::string_view source{};   ///< the file of this folder that computes it, without extension; none for costs
  /// Of a model-level metric: its value from the closed form, or nothing when the model has none.
  std::optional<double> (*of_model)(const Model&, const Target&, const Domain&) = nullptr;
  /// Of a sample-level metric. `seed` fixes what the metric draws itself (projections, points).
  std::unique_ptr<SampleMetric> (*of_samples)(const Target&, const Domain&, Seed seed) = nullptr;
  /// Of a sample-level metric that holds samples against the model's own Gaussian limit and not against the exemplar's
  /// law: null when the model has none. Its floor is that of samples of the limit.
  std::unique_ptr<SampleMetric> (*of_limit)(const Model&, const Domain&, Seed seed) = nullptr;
  /// Tests a statement of theory rather than how good a method is: measured when asked for by name or as "@identity".
  bool identity = false;
};

/// All metrics in the order they are listed. Those of cost and frame have no function: execute.cpp and gpu_run.cpp
/// measure them.
std::span<const MetricEntry> metric_catalog();
/// Throws std::invalid_argument naming the nearest known name.
const MetricEntry& find_metric(std::string_view name);

/// Mean-statistic value and its delete-one jackknife standard error over the samples (none for a single sample).
MetricValue measure_samples(const SampleMetric& metric, std::span<const Image> samples, const Domain& domain);

}  // namespace textonbench
