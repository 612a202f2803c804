#include "methods/sparse/wave_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "methods/base/aligned_buffer.h"
#include "methods/base/image.h"
#include "methods/base/parallel.h"
#include "methods/sparse/wave_lanes.h"
#include "methods/sparse/wave_sum.h"

namespace textonbench {
namespace {

using PointLanes = SixteenLanes;
constexpr int lanes = PointLanes::count;

/// Points of one task: its cells are drawn anew.
constexpr std::size_t task_points = 1024;

/// Windows of the nine lattice points around a point at (x[i], y[i]) spacings from them, and their slopes, a spacing:
/// whole vectors, zero beyond the windows' reach.
struct WindowsAround {
  alignas(64) float value[lanes];
  alignas(64) float slope_x[lanes];
  alignas(64) float slope_y[lanes];
};

__attribute__((target_clones("default", "avx2", "avx512f"))) void windows_at(
    const std::array<float, lrp_window_terms>& polynomial, const float* x, const float* y, WindowsAround& windows) {
  using Floats = PointLanes::Floats;
  const Floats dx = *reinterpret_cast<const Floats*>(x), dy = *reinterpret_cast<const Floats*>(y);
  Floats t = 1 - (dx * dx + dy * dy) * (1 / 2.25F);
  t = t > 0 ? t : Floats{};
  Floats p{}, slope{}, root{};
  for (int m = lrp_window_terms - 1; m >= 0; --m) {
    slope = slope * t + p;
    p = p * t + polynomial[static_cast<std::size_t>(m)];
  }
  for (int i = 0; i < lanes; ++i) root[i] = std::sqrt(t[i]);
  const Floats along = root * (1.5F * p + t * slope) * (-2 / 2.25F);
  *reinterpret_cast<Floats*>(windows.value) = t * root * p;
  *reinterpret_cast<Floats*>(windows.slope_x) = along * dx;
  *reinterpret_cast<Floats*>(windows.slope_y) = along * dy;
}

/// The cells that were drawn last: so many that those of a row of points are kept for the next.
class CellStore {
 public:
  CellStore(const WaveField& field, const WaveLattice& lattice)
      : lattice_(lattice),
        channels_(field.channels),
        padded_((lattice.layer().waves() + lanes - 1) / lanes * lanes),
        places_(slots),
        integers_(static_cast<std::size_t>(3 * padded_) * slots),
        colors_(static_cast<std::size_t>(2 * channels_ * padded_) * slots) {}

  PaddedWaves at(std::int64_t cx, std::int64_t cy) {
    const auto slot = static_cast<std::size_t>((cx + 683 * cy) & (slots - 1));
    std::int32_t* kx = integers_.data() + slot * static_cast<std::size_t>(3 * padded_);
    auto* phase = reinterpret_cast<std::uint32_t*>(kx + std::ptrdiff_t{2} * padded_);
    float* color = colors_.data() + slot * static_cast<std::size_t>(2 * channels_ * padded_);
    Place& place = places_[slot];
    if (!place.drawn || place.x != cx || place.y != cy) {
      place = {cx, cy, true};
      lattice_.draw(cx, cy, 1, drawn_);
      std::fill_n(kx, 3 * padded_, 0);
      std::fill_n(color, 2 * channels_ * padded_, 0.0F);
      const WaveLayer& layer = lattice_.layer();
      const auto waves = static_cast<std::size_t>(layer.waves());
      std::copy_n(drawn_.kx.begin(), waves, kx);
      std::copy_n(drawn_.ky.begin(), waves, kx + padded_);
      std::copy_n(drawn_.phase.begin(), waves, phase);
      for (std::size_t j = 0; j < waves; ++j) {
        const std::complex<float>* from =
            layer.color.data() + std::size_t{drawn_.color[j]} * static_cast<std::size_t>(channels_);
        float* to = color + j;
        for (int c = 0; c < channels_; ++c, to += std::ptrdiff_t{2} * padded_) {
          to[0] = from[c].real();
          to[padded_] = from[c].imag();
        }
      }
    }
    return {padded_, kx, kx + padded_, phase, color};
  }

 private:
  static constexpr std::int64_t slots = 2048;
  struct Place {
    std::int64_t x = 0, y = 0;
    bool drawn = false;
  };
  const WaveLattice& lattice_;
  int channels_;
  int padded_;
  DrawnWaves drawn_;
  std::vector<Place> places_;
  AlignedBuffer<std::int32_t> integers_;
  AlignedBuffer<float> colors_;
};

/// Adds a layer at some points.
void add_layer(const WaveField& field, const WaveLattice& lattice, std::span<const WavePoint> points, bool slopes,
               std::span<float> out, std::size_t stride, WaveCounts& counts) {
  CellStore cells(field, lattice);
  const auto& polynomial = lrp_window_polynomial(field.window);
  const auto channels = static_cast<std::size_t>(field.channels);
  const float a_unit = 1 / static_cast<float>(lattice.layer().spacing);
  const auto a_pixel = static_cast<float>(1 / lattice.layer().pixels());
  const auto a_bin = static_cast<float>(2 * std::numbers::pi / (1 << field.side_bits));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int64_t cx = lattice.nearest_x(points[i].x), cy = lattice.nearest_y(points[i].y);
    std::int64_t dx[3], dy[3];
    for (int k = 0; k < 3; ++k) {
      dx[k] = points[i].x - lattice.center_x(cx - 1 + k);
      dy[k] = points[i].y - lattice.center_y(cy - 1 + k);
    }
    alignas(64) float x[lanes], y[lanes];
    for (int k = 0; k < lanes; ++k) {  // lanes beyond the ninth are out of reach
      const int column = k % 3, row = k / 3;
      x[k] = k < most_waves_around ? static_cast<float>(dx[column]) * a_unit : 2.0F;
      y[k] = k < most_waves_around ? static_cast<float>(dy[row]) * a_unit : 2.0F;
    }
    WindowsAround windows;
    windows_at(polynomial, x, y, windows);
    counts.windows += most_waves_around;
    counts.cosines += std::int64_t{most_waves_around} * lattice.layer().waves();
    WavesAround around;
    float squares = 0, squares_x = 0, squares_y = 0;
    for (int k = 0; k < most_waves_around; ++k) {
      const float w = windows.value[k];
      if (w <= 0) continue;
      const int at = around.count++;
      around.waves[at] = cells.at(cx - 1 + k % 3, cy - 1 + k / 3);
      around.turn_x[at] = field.turns(dx[k % 3]);
      around.turn_y[at] = field.turns(dy[k / 3]);
      around.window[at] = w;
      around.slope_x[at] = windows.slope_x[k] * a_pixel;
      around.slope_y[at] = windows.slope_y[k] * a_pixel;
      squares += w * w;
      squares_x += w * around.slope_x[at];
      squares_y += w * around.slope_y[at];
    }
    PointSums sums;
    if (slopes) {
      sum_wave_slopes(around, field.channels, a_bin, sums);
    } else {
      sum_wave_values(around, field.channels, sums);
    }
    const float scale = field.even_variance ? 1 / std::sqrt(squares) : 1;
    for (std::size_t c = 0; c < channels; ++c) {
      out[c * stride + i] += scale * sums.value[c];
      if (!slopes) continue;
      const float even = field.even_variance ? sums.value[c] / squares : 0;
      out[(channels + c) * stride + i] += scale * (sums.slope_x[c] - even * squares_x);
      out[(2 * channels + c) * stride + i] += scale * (sums.slope_y[c] - even * squares_y);
    }
  }
}

}  // namespace

void sum_waves(const WaveField& field, Seed seed, std::span<const WavePoint> points, bool slopes, std::span<float> out,
               WaveCounts* counts) {
  std::fill(out.begin(), out.end(), 0.0F);
  std::vector<WaveLattice> lattices;
  lattices.reserve(field.layers.size());
  for (std::size_t l = 0; l < field.layers.size(); ++l) lattices.emplace_back(field, l, seed);
  const std::size_t tasks = (points.size() + task_points - 1) / task_points;
  std::vector<WaveCounts> counted(tasks);
  parallel_for(static_cast<int>(tasks), [&](int task) {
    const std::size_t first = static_cast<std::size_t>(task) * task_points;
    const std::size_t count = std::min(task_points, points.size() - first);
    for (const WaveLattice& lattice : lattices) {
      add_layer(field, lattice, points.subspan(first, count), slopes, out.subspan(first), points.size(),
                counted[static_cast<std::size_t>(task)]);
    }
  });
  if (counts == nullptr) return;
  for (const WaveCounts& one : counted) {
    counts->windows += one.windows;
    counts->cosines += one.cosines;
  }
}

}  // namespace textonbench
