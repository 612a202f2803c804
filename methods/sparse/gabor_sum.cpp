#include "methods/sparse/gabor_sum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "methods/base/parallel.h"
#include "methods/base/portable_math.h"

namespace textonbench {
namespace {

constexpr double units_a_pixel = static_cast<double>(plane_pixel);
/// Side of the rectangles whose impacts are drawn at a time, in raster pixels.
constexpr int gabor_tile = 64;

std::int64_t plane_coordinate(double at) { return static_cast<std::int64_t>(std::floor(at * units_a_pixel)); }

/// g along one axis, from a table: exp(−π a² t²), |t| <= R, within 3e-7.
class GaussianTable {
 public:
  explicit GaussianTable(const GaborBand& band) : scale_(nodes / (band.radius * units_a_pixel)), values_(nodes + 2) {
    for (int i = 0; i < nodes + 2; ++i) {
      const double t = band.radius * i / nodes;
      values_[static_cast<std::size_t>(i)] =
          static_cast<float>(std::exp(-std::numbers::pi * std::pow(band.bandwidth * t, 2)));
    }
  }
  /// `distance` in 2^−22 pixel.
  float at(std::int64_t distance) const {
    const auto place = static_cast<float>(std::abs(static_cast<double>(distance)) * scale_);
    const auto node = static_cast<std::size_t>(place);
    const float part = place - static_cast<float>(node);
    return values_[node] + part * (values_[node + 1] - values_[node]);
  }

 private:
  static constexpr int nodes = 2048;
  double scale_;
  std::vector<float> values_;
};

/// Part of a kernel along an axis.
struct AxisPart {
  float real = 0;
  float imaginary = 0;
};

/// `frequency` in 2^−32 turn a pixel, `distance` in 2^−22 pixel, at most 512 pixels.
AxisPart axis_part(const GaussianTable& table, std::int64_t frequency, std::int64_t distance, std::uint32_t phase) {
  constexpr int dropped = 2;
  const std::int64_t turns = (frequency * (distance >> dropped)) >> (plane_bits - dropped);
  float cosine = 0, sine = 0;
  portable::cos_sin(static_cast<std::uint32_t>(turns) + phase, cosine, sine);
  const float window = table.at(distance);
  return {window * cosine, window * sine};
}

std::int64_t turns_a_pixel(double frequency) { return std::llround(frequency * 0x1p32); }

double squared_pixel_distance(std::int64_t distance) {
  const double d = static_cast<double>(distance) / units_a_pixel;
  return d * d;
}

/// w c (row part), what the columns of a channel are multiplied by.
AxisPart times_color(const AxisPart& row, const std::complex<float>& color, float weight) {
  return {weight * (color.real() * row.real - color.imag() * row.imaginary),
          weight * (color.real() * row.imaginary + color.imag() * row.real)};
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void add_row(const AxisPart& row, const float* real,
                                                                          const float* imaginary, int count,
                                                                          float* out) {
  for (int x = 0; x < count; ++x) out[x] += row.real * real[x] - row.imaginary * imaginary[x];
}

/// A kernel on a part of a raster whose coordinates are x and y.
class KernelRaster {
 public:
  KernelRaster(const GaborField& field, const GaborBand& band)
      : channels_(field.channels), band_(band), table_(band), reach_(plane_coordinate(band.radius) + 1) {}

  std::int64_t reach() const { return reach_; }

  /// Adds it to `out`, whose pixel (left + i, top + j) is at (x[i], y[j]).
  void add(const GaborImpact& impact, const std::vector<std::int64_t>& x, const std::vector<std::int64_t>& y, int left,
           int top, Image& out) {
    const auto from = std::ranges::upper_bound(x, impact.x - reach_),
               to = std::ranges::lower_bound(x, impact.x + reach_);
    const auto above = std::ranges::upper_bound(y, impact.y - reach_);
    const auto below = std::ranges::lower_bound(y, impact.y + reach_);
    if (from >= to || above >= below) return;
    const GaborFrequency& f = band_.frequency[impact.entry];
    const auto columns = static_cast<std::size_t>(to - from);
    real_.resize(columns), imaginary_.resize(columns), squares_.resize(columns);
    const std::int64_t along_x = turns_a_pixel(f.x), along_y = turns_a_pixel(f.y);
    for (std::size_t i = 0; i < columns; ++i) {
      const std::int64_t distance = from[static_cast<std::ptrdiff_t>(i)] - impact.x;
      squares_[i] = squared_pixel_distance(distance);
      const AxisPart part = axis_part(table_, along_x, clamped(distance), 0);
      real_[i] = part.real, imaginary_[i] = part.imaginary;
    }
    const std::complex<float>* color =
        band_.color.data() + std::size_t{impact.entry} * static_cast<std::size_t>(channels_);
    for (auto row = above; row < below; ++row) {
      const std::int64_t distance = *row - impact.y;
      const double left_over = band_.radius * band_.radius - squared_pixel_distance(distance);
      std::size_t first = 0, end = columns;
      while (first < end && squares_[first] >= left_over) ++first;
      while (end > first && squares_[end - 1] >= left_over) --end;
      if (first == end) continue;
      const AxisPart part = axis_part(table_, along_y, clamped(distance), impact.phase);
      const auto y_out = top + static_cast<int>(row - y.begin());
      const auto x_out = static_cast<std::size_t>(left) + static_cast<std::size_t>(from - x.begin()) + first;
      for (int c = 0; c < channels_; ++c) {
        add_row(times_color(part, color[c], impact.weight), real_.data() + first, imaginary_.data() + first,
                static_cast<int>(end - first), out.row(c, y_out).data() + x_out);
      }
    }
  }

 private:
  /// Distances within the table: those a rounding beyond it are cut off by the disc anyway.
  std::int64_t clamped(std::int64_t distance) const { return std::clamp(distance, 1 - reach_, reach_ - 1); }

  int channels_;
  const GaborBand& band_;
  GaussianTable table_;
  std::int64_t reach_;
  std::vector<float> real_, imaginary_;
  std::vector<double> squares_;
};

PlaneRectangle with_margin(std::int64_t left, std::int64_t top, std::int64_t right, std::int64_t bottom,
                           std::int64_t reach) {
  return {left - reach, top - reach, right + reach + 1, bottom + reach + 1};
}

}  // namespace

void sum_gabor(const GaborField& field, Seed seed, std::span<const WavePoint> points, std::span<float> out) {
  constexpr std::size_t chunk = 256;
  const auto channels = static_cast<std::size_t>(field.channels);
  parallel_for(static_cast<int>((points.size() + chunk - 1) / chunk), [&](int task) {
    const std::size_t first = static_cast<std::size_t>(task) * chunk, end = std::min(points.size(), first + chunk);
    std::vector<GaborImpact> impacts;
    std::vector<std::int64_t> x(1), y(1);
    Image value({1, 1}, field.channels);
    std::vector<GaborImpacts> drawers;
    std::vector<KernelRaster> kernels;
    for (std::size_t b = 0; b < field.bands.size(); ++b) {
      drawers.emplace_back(field, b, seed);
      kernels.emplace_back(field, field.bands[b]);
    }
    for (std::size_t i = first; i < end; ++i) {
      x[0] = points[i].x, y[0] = points[i].y;
      for (std::size_t c = 0; c < channels; ++c) value.at(static_cast<int>(c), 0, 0) = 0;
      for (std::size_t b = 0; b < kernels.size(); ++b) {
        impacts.clear();
        drawers[b].draw(with_margin(x[0], y[0], x[0], y[0], kernels[b].reach()), impacts);
        for (const GaborImpact& impact : impacts) kernels[b].add(impact, x, y, 0, 0, value);
      }
      for (std::size_t c = 0; c < channels; ++c) out[c * points.size() + i] = value.at(static_cast<int>(c), 0, 0);
    }
  });
}

void add_gabor(const GaborField& field, Seed seed, const WaveRaster& raster, Image& out) {
  const int across = (out.width() + gabor_tile - 1) / gabor_tile, down = (out.height() + gabor_tile - 1) / gabor_tile;
  parallel_for(across * down, [&](int tile) {
    const int left = tile % across * gabor_tile, top = tile / across * gabor_tile;
    std::vector<std::int64_t> x, y;
    for (int i = left; i < std::min(left + gabor_tile, out.width()); ++i) {
      x.push_back(plane_coordinate(raster.x + raster.step * i));
    }
    for (int i = top; i < std::min(top + gabor_tile, out.height()); ++i) {
      y.push_back(plane_coordinate(raster.y + raster.step * i));
    }
    // Sums start at zero, as at points.
    Image sum({static_cast<int>(x.size()), static_cast<int>(y.size())}, field.channels);
    std::vector<GaborImpact> impacts;
    for (std::size_t b = 0; b < field.bands.size(); ++b) {
      KernelRaster kernel(field, field.bands[b]);
      impacts.clear();
      GaborImpacts(field, b, seed).draw(with_margin(x.front(), y.front(), x.back(), y.back(), kernel.reach()), impacts);
      for (const GaborImpact& impact : impacts) kernel.add(impact, x, y, 0, 0, sum);
    }
    for (int c = 0; c < field.channels; ++c) {
      for (int j = 0; j < sum.height(); ++j) {
        float* to = out.row(c, top + j).data() + left;
        const auto from = sum.row(c, j);
        for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
      }
    }
  });
}

}  // namespace textonbench
