#include "methods/sparse/gabor_sum.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/base/parallel.h"
#include "methods/sparse/gabor_kernel.h"

namespace textonbench {
namespace {

constexpr double units_a_pixel = static_cast<double>(plane_pixel);
/// Least and greatest side of the rectangles whose impacts are drawn at a time, in raster pixels.
constexpr int least_gabor_tile = 64;
constexpr int most_gabor_tile = 256;

std::int64_t plane_coordinate(double at) { return static_cast<std::int64_t>(std::floor(at * units_a_pixel)); }

PlaneRectangle with_margin(std::int64_t left, std::int64_t top, std::int64_t right, std::int64_t bottom,
                           const GaborShape& shape) {
  return {left - shape.reach_x, top - shape.reach_y, right + shape.reach_x + 1, bottom + shape.reach_y + 1};
}

/// w c (part along y): what parts along x are multiplied by.
struct ColoredPart {
  float real = 0;
  float imaginary = 0;
};

ColoredPart times_color(float real, float imaginary, const std::complex<float>& color, float weight) {
  return {weight * (color.real() * real - color.imag() * imaginary),
          weight * (color.real() * imaginary + color.imag() * real)};
}

/// Some rows of a kernel. Row j has the columns first[j] … end[j] − 1 and a part for each channel.
struct KernelRows {
  const float* real = nullptr;
  const float* imaginary = nullptr;
  const int* first = nullptr;
  const int* end = nullptr;
  const ColoredPart* parts = nullptr;
  int rows = 0;
  int channels = 0;
  float* out = nullptr;
  std::ptrdiff_t row_stride = 0;
  std::ptrdiff_t plane_stride = 0;
};

__attribute__((target_clones("default", "avx2", "avx512f"))) void add_rows(const KernelRows& kernel) {
  const float *real = kernel.real, *imaginary = kernel.imaginary;
  for (int j = 0; j < kernel.rows; ++j) {
    const ColoredPart* part = kernel.parts + std::ptrdiff_t{j} * kernel.channels;
    float* __restrict out = kernel.out + j * kernel.row_stride;
    if (kernel.channels == 3) {
      float* __restrict second = out + kernel.plane_stride;
      float* __restrict third = second + kernel.plane_stride;
      const ColoredPart one = part[0], two = part[1], three = part[2];
      for (int x = kernel.first[j]; x < kernel.end[j]; ++x) {
        out[x] += one.real * real[x] - one.imaginary * imaginary[x];
        second[x] += two.real * real[x] - two.imaginary * imaginary[x];
        third[x] += three.real * real[x] - three.imaginary * imaginary[x];
      }
      continue;
    }
    for (int c = 0; c < kernel.channels; ++c, out += kernel.plane_stride) {
      const ColoredPart one = part[c];
      for (int x = kernel.first[j]; x < kernel.end[j]; ++x) out[x] += one.real * real[x] - one.imaginary * imaginary[x];
    }
  }
}

/// Kernels of a band on a part of a raster.
class KernelRaster {
 public:
  KernelRaster(const GaborField& field, const GaborBand& band) : channels_(field.channels), band_(band), shape_(band) {}

  const GaborShape& shape() const { return shape_; }

  /// Adds a kernel to `out`, whose pixel (i, j) is at (x[i], y[j]).
  void add(const GaborImpact& impact, const std::vector<std::int64_t>& x, const std::vector<std::int64_t>& y,
           Image& out) {
    const auto from = std::ranges::upper_bound(x, impact.x - shape_.reach_x);
    const auto to = std::ranges::lower_bound(x, impact.x + shape_.reach_x);
    const auto above = std::ranges::upper_bound(y, impact.y - shape_.reach_y);
    const auto below = std::ranges::lower_bound(y, impact.y + shape_.reach_y);
    if (from >= to || above >= below) return;
    const std::int32_t* frequency = shape_.frequency.data() + std::size_t{2} * impact.entry;
    rows_.resize(static_cast<int>(below - above));
    for (int j = 0; j < rows_.count(); ++j) rows_.distance()[j] = place_distance(above[j], impact.y);
    rows_.set_waves(frequency[1], impact.phase);
    rows_.set_windows(shape_.across, rows_.distance(), 0, rows_.count());
    columns_.resize(static_cast<int>(to - from));
    for (int i = 0; i < columns_.count(); ++i) columns_.distance()[i] = place_distance(from[i], impact.x);
    columns_.set_waves(frequency[0], 0);
    const int left = static_cast<int>(from - x.begin()), top = static_cast<int>(above - y.begin());
    color_rows(impact);
    first_.resize(parts_.size()), end_.resize(parts_.size());
    if (shape_.shear == 0) {
      columns_.set_windows(shape_.along, columns_.distance(), 0, columns_.count());
      for (int j = 0; j < rows_.count(); ++j) find_chord(columns_.distance(), j, 0, columns_.count());
      add_some(0, rows_.count(), left, top, out);
      return;
    }
    for (int j = 0; j < rows_.count(); ++j) {
      shear_columns(j);
      add_some(j, j + 1, left, top, out);
    }
  }

 private:
  /// Parts along y of all rows, in the impact's colors.
  void color_rows(const GaborImpact& impact) {
    const auto channels = static_cast<std::size_t>(channels_);
    const std::complex<float>* color = band_.color.data() + std::size_t{impact.entry} * channels;
    parts_.resize(static_cast<std::size_t>(rows_.count()) * channels);
    for (std::size_t j = 0; j < static_cast<std::size_t>(rows_.count()); ++j) {
      for (std::size_t c = 0; c < channels; ++c) {
        parts_[j * channels + c] = times_color(rows_.real()[j], rows_.imaginary()[j], color[c], impact.weight);
      }
    }
  }

  /// Windows of a row's columns, around a middle of its own.
  void shear_columns(int row) {
    const std::int32_t shift = sheared(shape_.shear, rows_.distance()[row]);
    const std::int32_t* distance = columns_.distance();
    const auto count = static_cast<std::size_t>(columns_.count());
    shifted_.resize(count + KernelPlaces::block);
    for (std::size_t i = 0; i < count; ++i) shifted_[i] = distance[i] + shift;
    const auto [first, end] = near_chord(shifted_.data(), row);
    columns_.set_windows(shape_.along, shifted_.data(), first, end);
    find_chord(shifted_.data(), row, first, end);
  }

  /// Columns of a row that its chord lies in, and two more on both sides.
  std::pair<int, int> near_chord(const std::int32_t* distance, int row) const {
    const float room = shape_.limit - rows_.form()[row];
    if (!(room > 0)) return {0, 0};
    const double half = std::sqrt(double{room} / double{shape_.along}) * 0x1p20;
    const int last = columns_.count() - 1;
    const double step = last > 0 ? (static_cast<double>(distance[last]) - distance[0]) / last : 1;
    const double from = (-half - distance[0]) / step, to = (half - distance[0]) / step;
    return {static_cast<int>(std::clamp(from - 2, 0.0, last + 1.0)),
            static_cast<int>(std::clamp(to + 3, 0.0, last + 1.0))};
  }

  /// The columns of a row, among some, whose form leaves room: neighbors of each other.
  void find_chord(const std::int32_t* distance, int row, int low, int high) {
    const auto at = static_cast<std::size_t>(row);
    auto [first, end] = near_chord(distance, row);
    first = std::max(first, low), end = std::min(end, high);
    const float room = shape_.limit - rows_.form()[row];
    const float* form = columns_.form();
    while (first < end && !(form[first] < room)) ++first;
    while (end > first && !(form[end - 1] < room)) --end;
    first_[at] = first, end_[at] = end;
  }

  void add_some(int first, int end, int left, int top, Image& out) const {
    add_rows({.real = columns_.real(),
              .imaginary = columns_.imaginary(),
              .first = first_.data() + first,
              .end = end_.data() + first,
              .parts = parts_.data() + std::ptrdiff_t{first} * channels_,
              .rows = end - first,
              .channels = channels_,
              .out = out.row(0, top + first).data() + left,
              .row_stride = out.row_stride(),
              .plane_stride = out.row_stride() * out.height()});
  }

  int channels_;
  const GaborBand& band_;
  GaborShape shape_;
  KernelPlaces rows_, columns_;
  std::vector<std::int32_t> shifted_;
  std::vector<ColoredPart> parts_;
  std::vector<int> first_, end_;
};

/// Side of the tiles of a raster: kernels reach beyond them by less than a half of it, where it is not the greatest.
int gabor_tile(const GaborField& field, double step) {
  double reach = 0;
  for (const GaborBand& band : field.bands) {
    reach = std::max({reach, band.window.half_width(), band.window.half_height()});
  }
  int side = least_gabor_tile;
  while (side < most_gabor_tile && side * step < 4 * reach) side *= 2;
  return side;
}

}  // namespace

void add_gabor(const GaborField& field, Seed seed, const WaveRaster& raster, Image& out) {
  const int side = gabor_tile(field, raster.step);
  const int across = (out.width() + side - 1) / side, down = (out.height() + side - 1) / side;
  parallel_for(across * down, [&](int tile) {
    const int left = tile % across * side, top = tile / across * side;
    std::vector<std::int64_t> x, y;
    for (int i = left; i < std::min(left + side, out.width()); ++i) {
      x.push_back(plane_coordinate(raster.x + raster.step * i));
    }
    for (int i = top; i < std::min(top + side, out.height()); ++i) {
      y.push_back(plane_coordinate(raster.y + raster.step * i));
    }
    std::vector<GaborImpact> impacts;
    for (std::size_t b = 0; b < field.bands.size(); ++b) {
      // The sum of each band starts at zero, as at points.
      Image sum({static_cast<int>(x.size()), static_cast<int>(y.size())}, field.channels);
      KernelRaster kernel(field, field.bands[b]);
      impacts.clear();
      GaborImpacts(field, b, seed).draw(with_margin(x.front(), y.front(), x.back(), y.back(), kernel.shape()), impacts);
      for (const GaborImpact& impact : impacts) kernel.add(impact, x, y, sum);
      for (int c = 0; c < field.channels; ++c) {
        for (int j = 0; j < sum.height(); ++j) {
          float* to = out.row(c, top + j).data() + left;
          const auto from = sum.row(c, j);
          for (std::size_t i = 0; i < from.size(); ++i) to[i] += from[i];
        }
      }
    }
  });
}

}  // namespace textonbench
