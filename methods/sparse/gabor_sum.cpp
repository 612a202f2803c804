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

/// exp(−π c t²) from a table, |t| <= R, within 3e-7.
class GaussianTable {
 public:
  GaussianTable(double coefficient, double reach) : scale_(nodes / (reach * units_a_pixel)), values_(nodes + 2) {
    for (int i = 0; i < nodes + 2; ++i) {
      const double t = reach * i / nodes;
      values_[static_cast<std::size_t>(i)] = static_cast<float>(std::exp(-std::numbers::pi * coefficient * t * t));
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
AxisPart axis_wave(std::int64_t frequency, std::int64_t distance, std::uint32_t phase) {
  constexpr int dropped = 2;
  const std::int64_t turns = (frequency * (distance >> dropped)) >> (plane_bits - dropped);
  AxisPart wave;
  portable::cos_sin(static_cast<std::uint32_t>(turns) + phase, wave.real, wave.imaginary);
  return wave;
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

__attribute__((target_clones("default", "avx2", "avx512f"))) void add_row(const AxisPart& row, const AxisPart* columns,
                                                                          int count, float* out) {
  for (int x = 0; x < count; ++x) out[x] += row.real * columns[x].real - row.imaginary * columns[x].imaginary;
}

/// Kernels on a part of a raster whose coordinates are x and y. Along a row the window is exp(−π xx (dx + shear dy)²)
/// by a factor of the row, so where there is no shear columns have one factor for all rows.
class KernelRaster {
 public:
  KernelRaster(const GaborField& field, const GaborBand& band)
      : channels_(field.channels),
        band_(band),
        shear_(band.window.xy / band.window.xx),
        across_(band.window.determinant() / band.window.xx),
        columns_(band.window.xx, std::sqrt(band.window.limit() / band.window.xx)),
        rows_(across_, band.window.half_height()),
        row_reach_(plane_coordinate(std::sqrt(band.window.limit() / band.window.xx)) + 1),
        reach_x_(plane_coordinate(band.window.half_width()) + 1),
        reach_y_(plane_coordinate(band.window.half_height()) + 1) {}

  std::int64_t reach_x() const { return reach_x_; }
  std::int64_t reach_y() const { return reach_y_; }

  /// Adds it to `out`, whose pixel (i, j) is at (x[i], y[j]).
  void add(const GaborImpact& impact, const std::vector<std::int64_t>& x, const std::vector<std::int64_t>& y,
           Image& out) {
    const auto from = std::ranges::upper_bound(x, impact.x - reach_x_),
               to = std::ranges::lower_bound(x, impact.x + reach_x_);
    const auto above = std::ranges::upper_bound(y, impact.y - reach_y_),
               below = std::ranges::lower_bound(y, impact.y + reach_y_);
    if (from >= to || above >= below) return;
    const GaborFrequency& f = band_.frequency[impact.entry];
    const std::int64_t along_x = turns_a_pixel(f.x), along_y = turns_a_pixel(f.y);
    const auto columns = static_cast<std::size_t>(to - from);
    wave_.resize(columns), part_.resize(columns), forms_.resize(columns);
    for (std::size_t i = 0; i < columns; ++i) {
      wave_[i] =
          axis_wave(along_x, std::clamp(from[static_cast<std::ptrdiff_t>(i)] - impact.x, -reach_x_, reach_x_), 0);
    }
    if (shear_ == 0) set_windows(&*from, impact.x);
    const std::complex<float>* color =
        band_.color.data() + std::size_t{impact.entry} * static_cast<std::size_t>(channels_);
    for (auto row = above; row < below; ++row) {
      const std::int64_t distance = *row - impact.y;
      if (shear_ != 0) set_windows(&*from, impact.x - std::llround(shear_ * static_cast<double>(distance)));
      const double left_over = band_.window.limit() - across_ * squared_pixel_distance(distance);
      std::size_t first = 0, end = columns;
      while (first < end && forms_[first] >= left_over) ++first;
      while (end > first && forms_[end - 1] >= left_over) --end;
      if (first == end) continue;
      AxisPart part = axis_wave(along_y, distance, impact.phase);
      const float window = rows_.at(std::clamp(distance, 1 - reach_y_, reach_y_ - 1));
      part = {window * part.real, window * part.imaginary};
      const auto y_out = static_cast<int>(row - y.begin());
      const auto x_out = static_cast<std::size_t>(from - x.begin()) + first;
      for (int c = 0; c < channels_; ++c) {
        add_row(times_color(part, color[c], impact.weight), part_.data() + first, static_cast<int>(end - first),
                out.row(c, y_out).data() + x_out);
      }
    }
  }

 private:
  /// Windows of the columns, and the forms' parts that are theirs, around a middle in 2^−22 pixel.
  void set_windows(const std::int64_t* x, std::int64_t middle) {
    for (std::size_t i = 0; i < wave_.size(); ++i) {
      const std::int64_t distance = x[i] - middle;
      forms_[i] = band_.window.xx * squared_pixel_distance(distance);
      const float window = columns_.at(std::clamp(distance, 1 - row_reach_, row_reach_ - 1));
      part_[i] = {window * wave_[i].real, window * wave_[i].imaginary};
    }
  }

  int channels_;
  const GaborBand& band_;
  double shear_, across_;
  GaussianTable columns_, rows_;
  std::int64_t row_reach_, reach_x_, reach_y_;
  std::vector<AxisPart> wave_, part_;
  std::vector<double> forms_;
};

PlaneRectangle with_margin(std::int64_t left, std::int64_t top, std::int64_t right, std::int64_t bottom,
                           const KernelRaster& kernel) {
  return {left - kernel.reach_x(), top - kernel.reach_y(), right + kernel.reach_x() + 1, bottom + kernel.reach_y() + 1};
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
        drawers[b].draw(with_margin(x[0], y[0], x[0], y[0], kernels[b]), impacts);
        for (const GaborImpact& impact : impacts) kernels[b].add(impact, x, y, value);
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
      GaborImpacts(field, b, seed).draw(with_margin(x.front(), y.front(), x.back(), y.back(), kernel), impacts);
      for (const GaborImpact& impact : impacts) kernel.add(impact, x, y, sum);
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
