#include "methods/sparse/wave_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "methods/base/aligned_buffer.h"
#include "methods/base/image.h"
#include "methods/base/parallel.h"
#include "methods/base/portable_math.h"

namespace textonbench {
namespace {

constexpr int lanes = 16;

/// Points of one task: its cells are drawn anew.
constexpr std::size_t task_points = 1024;

/// Waves of one cell, padded to whole vectors by waves of color zero: real parts of channel c from 2 c padded on,
/// imaginary parts `padded` later.
struct PaddedCell {
  int padded;
  const std::int32_t* kx;
  const std::int32_t* ky;
  const std::uint32_t* phase;
  const float* color;
};

/// Σ_j of one cell, by channel: values, and slopes along x and y in 1 / bin.
struct CellSums {
  float value[Image::max_channels];
  float slope_x[Image::max_channels];
  float slope_y[Image::max_channels];
};

float sum_lanes(const float* v) {
  float s[lanes / 2];
  for (int i = 0; i < lanes / 2; ++i) s[i] = v[i] + v[i + lanes / 2];
  for (int half = lanes / 4; half >= 1; half /= 2) {
    for (int i = 0; i < half; ++i) s[i] += s[i + half];
  }
  return s[0];
}

template <bool slopes>
[[gnu::always_inline]] inline void sum_cell(const PaddedCell& cell, int channels, std::uint32_t turn_x,
                                            std::uint32_t turn_y, CellSums& sums) {
  alignas(64) float value[Image::max_channels][lanes] = {};
  alignas(64) float slope_x[slopes ? Image::max_channels : 1][lanes] = {};
  alignas(64) float slope_y[slopes ? Image::max_channels : 1][lanes] = {};
  for (int first = 0; first < cell.padded; first += lanes) {
    alignas(64) float cosine[lanes], sine[lanes];
    const std::int32_t* kx = cell.kx + first;
    const std::int32_t* ky = cell.ky + first;
    const std::uint32_t* phase = cell.phase + first;
    for (int i = 0; i < lanes; ++i) {
      portable::cos_sin(
          static_cast<std::uint32_t>(kx[i]) * turn_x + static_cast<std::uint32_t>(ky[i]) * turn_y + phase[i], cosine[i],
          sine[i]);
    }
    for (int c = 0; c < channels; ++c) {
      const float* re = cell.color + std::ptrdiff_t{2} * c * cell.padded + first;
      const float* im = re + cell.padded;
      for (int i = 0; i < lanes; ++i) value[c][i] += re[i] * cosine[i] - im[i] * sine[i];
      if constexpr (slopes) {
        for (int i = 0; i < lanes; ++i) {
          const float turned = re[i] * sine[i] + im[i] * cosine[i];
          slope_x[c][i] -= static_cast<float>(kx[i]) * turned;
          slope_y[c][i] -= static_cast<float>(ky[i]) * turned;
        }
      }
    }
  }
  for (int c = 0; c < channels; ++c) {
    sums.value[c] = sum_lanes(value[c]);
    if constexpr (slopes) {
      sums.slope_x[c] = sum_lanes(slope_x[c]);
      sums.slope_y[c] = sum_lanes(slope_y[c]);
    }
  }
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void sum_values(const PaddedCell& cell, int channels,
                                                                             std::uint32_t turn_x, std::uint32_t turn_y,
                                                                             CellSums& sums) {
  sum_cell<false>(cell, channels, turn_x, turn_y, sums);
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void sum_slopes(const PaddedCell& cell, int channels,
                                                                             std::uint32_t turn_x, std::uint32_t turn_y,
                                                                             CellSums& sums) {
  sum_cell<true>(cell, channels, turn_x, turn_y, sums);
}

/// Window at a distance of (x, y) spacings, and its slopes, a spacing.
struct WindowValue {
  float value = 0, slope_x = 0, slope_y = 0;
};

WindowValue window_at(const std::array<float, lrp_window_terms>& polynomial, float x, float y) {
  const float t = 1 - (x * x + y * y) * (1 / 2.25F);
  if (t <= 0) return {};
  float p = 0, slope = 0;
  for (int m = lrp_window_terms - 1; m >= 0; --m) {
    slope = slope * t + p;
    p = p * t + polynomial[static_cast<std::size_t>(m)];
  }
  const float root = std::sqrt(t);
  const float along = root * (1.5F * p + t * slope) * (-2 / 2.25F);
  return {t * root * p, along * x, along * y};
}

/// The cells that were drawn last: so many that those of a row of points are kept for the next.
class CellStore {
 public:
  CellStore(const WaveField& field, const WaveLattice& lattice)
      : lattice_(lattice),
        channels_(field.channels),
        padded_((lattice.layer().waves() + lanes - 1) / lanes * lanes),
        waves_(static_cast<std::size_t>(lattice.layer().waves())),
        places_(slots),
        integers_(static_cast<std::size_t>(3 * padded_) * slots),
        colors_(static_cast<std::size_t>(2 * channels_ * padded_) * slots) {}

  PaddedCell at(std::int64_t cx, std::int64_t cy) {
    const auto slot = static_cast<std::size_t>((cx + 683 * cy) & (slots - 1));
    std::int32_t* kx = integers_.data() + slot * static_cast<std::size_t>(3 * padded_);
    auto* phase = reinterpret_cast<std::uint32_t*>(kx + std::ptrdiff_t{2} * padded_);
    float* color = colors_.data() + slot * static_cast<std::size_t>(2 * channels_ * padded_);
    Place& place = places_[slot];
    if (!place.drawn || place.x != cx || place.y != cy) {
      place = {cx, cy, true};
      lattice_.draw(cx, cy, waves_);
      std::fill_n(kx, 3 * padded_, 0);
      std::fill_n(color, 2 * channels_ * padded_, 0.0F);
      for (std::size_t j = 0; j < waves_.size(); ++j) {
        kx[j] = waves_[j].bin.kx;
        kx[padded_ + static_cast<std::ptrdiff_t>(j)] = waves_[j].bin.ky;
        phase[j] = waves_[j].phase;
        float* to = color + j;
        for (int c = 0; c < channels_; ++c, to += std::ptrdiff_t{2} * padded_) {
          to[0] = waves_[j].color[c].real();
          to[padded_] = waves_[j].color[c].imag();
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
  std::vector<Wave> waves_;
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
  const auto spacing = static_cast<float>(lattice.layer().spacing);
  const auto a_pixel = static_cast<float>(1 / lattice.layer().pixels());
  const auto a_bin = static_cast<float>(2 * std::numbers::pi / (1 << field.side_bits));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const WavePoint& point = points[i];
    const std::int64_t cx = lattice.nearest_x(point.x), cy = lattice.nearest_y(point.y);
    float value[Image::max_channels] = {}, slope_x[Image::max_channels] = {}, slope_y[Image::max_channels] = {};
    float squares = 0, squares_x = 0, squares_y = 0;
    for (std::int64_t y = cy - 1; y <= cy + 1; ++y) {
      for (std::int64_t x = cx - 1; x <= cx + 1; ++x) {
        const std::int64_t dx = point.x - lattice.center_x(x), dy = point.y - lattice.center_y(y);
        const WindowValue w = window_at(polynomial, static_cast<float>(dx) / spacing, static_cast<float>(dy) / spacing);
        ++counts.windows;
        counts.cosines += lattice.layer().waves();
        if (w.value <= 0) continue;
        CellSums sums;
        if (slopes) {
          sum_slopes(cells.at(x, y), field.channels, field.turns(dx), field.turns(dy), sums);
        } else {
          sum_values(cells.at(x, y), field.channels, field.turns(dx), field.turns(dy), sums);
        }
        squares += w.value * w.value;
        for (std::size_t c = 0; c < channels; ++c) value[c] += w.value * sums.value[c];
        if (!slopes) continue;
        squares_x += w.value * w.slope_x * a_pixel;
        squares_y += w.value * w.slope_y * a_pixel;
        for (std::size_t c = 0; c < channels; ++c) {
          slope_x[c] += w.slope_x * a_pixel * sums.value[c] + w.value * a_bin * sums.slope_x[c];
          slope_y[c] += w.slope_y * a_pixel * sums.value[c] + w.value * a_bin * sums.slope_y[c];
        }
      }
    }
    const float scale = field.even_variance ? 1 / std::sqrt(squares) : 1;
    for (std::size_t c = 0; c < channels; ++c) {
      out[c * stride + i] += scale * value[c];
      if (!slopes) continue;
      const float even = field.even_variance ? value[c] / squares : 0;
      out[(channels + c) * stride + i] += scale * (slope_x[c] - even * squares_x);
      out[(2 * channels + c) * stride + i] += scale * (slope_y[c] - even * squares_y);
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
