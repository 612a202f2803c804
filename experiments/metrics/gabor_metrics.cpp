#include "experiments/metrics/gabor_metrics.h"

#include <array>
#include <set>

#include "methods/sparse/gabor.h"

namespace textonbench {
namespace {

constexpr MetricEntry gabor_row(std::string_view name, std::string_view title, std::string_view unit,
                                std::optional<double> (*of_model)(const Model&, const Target&, const Domain&),
                                std::string_view reference) {
  return {.name = name,
          .title = title,
          .unit = unit,
          .level = MetricLevel::model,
          .better = Better::lower,
          .reference = reference,
          .source = "gabor_metrics",
          .of_model = of_model,
          .identity = true};
}

}  // namespace

std::optional<double> gabor_kernels(const Model& model, const Target& /*target*/, const Domain& /*domain*/) {
  const GaborField* field = gabor_field_of(model);
  if (field == nullptr) return std::nullopt;
  std::size_t kernels = 0;
  for (const GaborBand& band : field->bands) {
    std::set<std::pair<double, double>> frequencies;
    for (const GaborFrequency& f : band.frequency) frequencies.emplace(f.x, f.y);
    kernels += frequencies.size();
  }
  return static_cast<double>(kernels);
}

std::optional<double> gabor_windows(const Model& model, const Target& /*target*/, const Domain& /*domain*/) {
  const GaborField* field = gabor_field_of(model);
  if (field == nullptr) return std::nullopt;
  return static_cast<double>(field->bands.size());
}

std::optional<double> gabor_impacts(const Model& model, const Target& /*target*/, const Domain& /*domain*/) {
  const GaborField* field = gabor_field_of(model);
  if (field == nullptr) return std::nullopt;
  double impacts = 0;
  for (const GaborBand& band : field->bands) impacts += band.intensity * band.window.area();
  return impacts;
}

std::span<const MetricEntry> gabor_metrics() {
  static constexpr std::array entries{
      gabor_row("gabor_kernels", "Kernels", "kernel", gabor_kernels, "pairs of a window and a frequency"),
      gabor_row("gabor_windows", "Windows", "window", gabor_windows, "each with a grid of impacts"),
      gabor_row("gabor_impacts", "Impacts at a point", "impact", gabor_impacts, "Σ λ |support|"),
  };
  return entries;
}

}  // namespace textonbench
