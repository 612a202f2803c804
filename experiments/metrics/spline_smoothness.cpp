#include "experiments/metrics/spline_smoothness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/metrics/spline_law.h"
#include "methods/base/impact_grid.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

constexpr double magnified_step = 1.0 / 20;

/// One channel of the raw noise at (i step, 0), i = 0 … count − 1.
std::vector<double> noise_on_line(const SplineTexton& texton, const ImpactGrid& grid, std::uint64_t key, int channel,
                                  int count, double step) {
  const double half_width = (texton.order + 1) / 2.0;
  const Extent extent = texton.coefficients.extent();
  const auto units = [](double x) { return static_cast<std::int64_t>(std::floor(std::ldexp(x, plane_bits))); };
  const PlaneRectangle around{units(-half_width - extent.width), units(-half_width - extent.height),
                              units(count * step + half_width + 1), units(half_width + 1)};
  std::vector<PlaneImpact> impacts;
  grid.draw(key, around, impacts);
  std::vector<double> line(static_cast<std::size_t>(count));
  for (const PlaneImpact& impact : impacts) {
    const double x = std::ldexp(static_cast<double>(impact.x), -plane_bits);
    const double y = std::ldexp(static_cast<double>(impact.y), -plane_bits);
    for (int i = 0; i < count; ++i) {
      line[static_cast<std::size_t>(i)] += impact.weight * spline_kernel(texton, channel, i * step - x, -y);
    }
  }
  return line;
}

/// Mean square of the differences of that order between every `stride`-th value.
double difference_energy(std::vector<double> values, int order, std::size_t stride) {
  for (int n = 0; n < order; ++n) {
    for (std::size_t i = 0; i + stride < values.size(); ++i) values[i] = values[i + stride] - values[i];
    values.resize(values.size() - stride);
  }
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

/// E |f(y + v) − f(y)|² over all channels.
double structure_function(const SplineCovariance& covariance, double x, double y) {
  return 2 * (covariance.total(0, 0) - covariance.total(x, y));
}

}  // namespace

std::optional<double> knot_exponent(const Model& model, const Target& target, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  constexpr int lines = 32;
  constexpr double step = 1.0 / 64, length = 8;
  const int differences = texton->order + 2, count = static_cast<int>(length / step) + 2 * differences;
  const ImpactGrid grid(ImpactProcess::poisson, 5 / texton->support_area, 16, 1);
  const Stream keys = Stream(Seed{1}).child("knot_exponent").child(target.exemplar.name);
  std::vector<double> fine(lines), coarse(lines);
  parallel_for(lines, [&](int i) {
    for (int c = 0; c < texton->coefficients.channels(); ++c) {
      const std::vector<double> line =
          noise_on_line(*texton, grid, keys.child(static_cast<std::uint64_t>(i)).key(), c, count, step);
      fine[static_cast<std::size_t>(i)] += difference_energy(line, differences, 1);
      coarse[static_cast<std::size_t>(i)] += difference_energy(line, differences, 2);
    }
  });
  double fine_sum = 0, coarse_sum = 0;
  for (const double energy : fine) fine_sum += energy;
  for (const double energy : coarse) coarse_sum += energy;
  return (std::log2(coarse_sum / fine_sum) - 1) / 2;
}

std::optional<double> subpixel_anisotropy(const Model& model, const Target&, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const SplineCovariance covariance(*texton);
  constexpr double diagonal = magnified_step / std::numbers::sqrt2;
  return (structure_function(covariance, diagonal, diagonal) + structure_function(covariance, diagonal, -diagonal)) /
         (structure_function(covariance, magnified_step, 0) + structure_function(covariance, 0, magnified_step));
}

std::optional<double> subpixel_gradient(const Model& model, const Target&, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  const SplineCovariance covariance(*texton);
  const double axes =
      structure_function(covariance, magnified_step, 0) + structure_function(covariance, 0, magnified_step);
  return axes / (2 * magnified_step * magnified_step * covariance.total(0, 0));
}

std::optional<double> covariance_overshoot(const Model& model, const Target&, const Domain&) {
  const SplineTexton* texton = single_spline_texton(model);
  if (texton == nullptr) return std::nullopt;
  constexpr int lags = 16;
  const SplineCovariance covariance(*texton);
  const auto excess = [](double before, double between, double after) {
    return std::max({0.0, between - std::max(before, after), std::min(before, after) - between});
  };
  double sum = 0;
  for (int c = 0; c < covariance.channels(); ++c) {
    for (int v = 0; v < lags; ++v) {
      sum += excess(covariance.at(c, v, 0), covariance.at(c, v + 0.5, 0), covariance.at(c, v + 1, 0));
      sum += excess(covariance.at(c, 0, v), covariance.at(c, 0, v + 0.5), covariance.at(c, 0, v + 1));
    }
  }
  return sum / covariance.total(0, 0);
}

}  // namespace textonbench
