#include "experiments/metrics/point_cost.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <memory>

#include "experiments/metrics/spline_law.h"
#include "methods/spot/spline_noise.h"

namespace textonbench {
namespace {

std::unique_ptr<Model> noise_with_cells(const SplineTexton& texton, double cell) {
  return make_spline_noise(texton, {.mni = 30, .cell = cell});
}

/// Median processor time of each model over turns that all of them take, each the first of a turn as often as the
/// others: what comes later finds the impacts of a seed in the caches and branches of the processor.
std::vector<double> median_times(std::span<const std::unique_ptr<Model>> models) {
  constexpr int turns = 42, rows = 16;
  constexpr double distance = 1021.37;  // beyond any support, and no multiple of a cell
  std::vector<Point2> points;
  points.reserve(std::size_t{rows} * rows);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < rows; ++x) points.push_back({distance * x, distance * y});
  }
  std::vector<float> values(points.size() * models.front()->spline_texton()->coefficients.mean.size());
  std::vector<std::vector<double>> times(models.size());
  for (std::uint64_t turn = 0; turn < turns; ++turn) {
    for (std::size_t place = 0; place < models.size(); ++place) {
      const std::size_t i = (place + turn) % models.size();
      const std::clock_t start = std::clock();
      models[i]->procedural()->evaluate(points, Seed{turn}, values);
      times[i].push_back(static_cast<double>(std::clock() - start));
    }
  }
  std::vector<double> medians;
  medians.reserve(times.size());
  for (std::vector<double>& of_model : times) {
    std::ranges::nth_element(of_model, of_model.begin() + turns / 2);
    medians.push_back(of_model[turns / 2]);
  }
  return medians;
}

}  // namespace

std::optional<double> cell_time_ratio(const Model& model, const Target&, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  std::vector<std::unique_ptr<Model>> models;
  models.push_back(noise_with_cells(*texton, 0.6));
  for (const double cell : {0.2, 0.4, 0.8, 1.0, 1.25, 1.5}) models.push_back(noise_with_cells(*texton, cell));
  const std::vector<double> times = median_times(models);
  return times.front() / *std::ranges::min_element(times);
}

std::optional<double> texton_time_ratio(const Model& model, const Target&, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  SplineTexton flat = *texton;
  Image& kernel = flat.coefficients.kernels.front();
  for (int c = 0; c < kernel.channels(); ++c) {
    for (int y = 0; y < kernel.height(); ++y) std::ranges::fill(kernel.row(c, y), 1.0F);
  }
  std::array<std::unique_ptr<Model>, 2> models{noise_with_cells(*texton, 0.6), noise_with_cells(flat, 0.6)};
  const std::vector<double> times = median_times(models);
  return times.front() / times.back();
}

}  // namespace textonbench
