#include "methods/sparse/gabor_sum.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/base/parallel.h"
#include "methods/sparse/gabor_kernel.h"

namespace textonbench {
namespace {

constexpr double units_a_pixel = static_cast<double>(plane_pixel);
/// Side of the rectangles whose impacts are drawn at a time, in raster pixels.
constexpr int gabor_tile = 64;

std::int64_t plane_coordinate(double at) { return static_cast<std::int64_t>(std::floor(at * units_a_pixel)); }

std::int64_t sheared(const GaborShape& shape, std::int64_t distance) {
  return shape.shear == 0 ? 0 : std::llround(shape.shear * static_cast<double>(distance));
}

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

__attribute__((target_clones("default", "avx2", "avx512f"))) void add_row(const ColoredPart& row, const float* real,
                                                                          const float* imaginary, int count,
                                                                          float* out) {
  for (int x = 0; x < count; ++x) out[x] += row.real * real[x] - row.imaginary * imaginary[x];
}

/// A row of three channels.
__attribute__((target_clones("default", "avx2", "avx512f"))) void add_color_row(const ColoredPart* row,
                                                                                const float* real,
                                                                                const float* imaginary, int count,
                                                                                float* first, float* second,
                                                                                float* third) {
  for (int x = 0; x < count; ++x) {
    const float re = real[x], im = imaginary[x];
    first[x] += row[0].real * re - row[0].imaginary * im;
    second[x] += row[1].real * re - row[1].imaginary * im;
    third[x] += row[2].real * re - row[2].imaginary * im;
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
    for (int j = 0; j < rows_.count(); ++j) rows_.distance()[j] = place_distance(above[j] - impact.y);
    rows_.set_waves(frequency[1], impact.phase);
    rows_.set_windows(shape_.across, rows_.distance());
    columns_.resize(static_cast<int>(to - from));
    for (int i = 0; i < columns_.count(); ++i) columns_.distance()[i] = place_distance(from[i] - impact.x);
    columns_.set_waves(frequency[0], 0);
    if (shape_.shear == 0) columns_.set_windows(shape_.along, columns_.distance());
    const int left = static_cast<int>(from - x.begin()), top = static_cast<int>(above - y.begin());
    int first = columns_.count() / 2, end = first;
    for (int j = 0; j < rows_.count(); ++j) {
      if (shape_.shear != 0) shear_columns(&*from, impact.x - sheared(shape_, above[j] - impact.y));
      find_chord(shape_.limit - rows_.form()[j], first, end);
      if (first < end) add_row_of(impact, j, left + first, top + j, first, end - first, out);
    }
  }

 private:
  void shear_columns(const std::int64_t* x, std::int64_t middle) {
    shifted_.resize(static_cast<std::size_t>(columns_.count() + KernelPlaces::block));
    for (int i = 0; i < columns_.count(); ++i) shifted_[static_cast<std::size_t>(i)] = place_distance(x[i] - middle);
    columns_.set_windows(shape_.along, shifted_.data());
  }

  /// The columns whose forms are below `room`: neighbors of each other, and of those of the row before.
  void find_chord(float room, int& first, int& end) const {
    const float* form = columns_.form();
    const int count = columns_.count();
    if (first == end) {
      first = static_cast<int>(std::min_element(form, form + count) - form);
      end = first;
      if (form[first] < room) ++end;
    }
    while (first < end && form[first] >= room) ++first;
    while (end > first && form[end - 1] >= room) --end;
    if (first == end) return find_again(room, first, end);
    while (first > 0 && form[first - 1] < room) --first;
    while (end < count && form[end] < room) ++end;
  }
  /// Where it has nothing in common with the row before.
  void find_again(float room, int& first, int& end) const {
    const float* form = columns_.form();
    const int count = columns_.count();
    first = static_cast<int>(std::min_element(form, form + count) - form), end = first;
    while (end < count && form[end] < room) ++end;
    while (first > 0 && first < end && form[first - 1] < room) --first;
  }

  void add_row_of(const GaborImpact& impact, int row, int x, int y, int first, int count, Image& out) const {
    const std::complex<float>* color =
        band_.color.data() + std::size_t{impact.entry} * static_cast<std::size_t>(channels_);
    const float real = rows_.real()[row], imaginary = rows_.imaginary()[row];
    if (channels_ == 3) {
      const ColoredPart parts[] = {times_color(real, imaginary, color[0], impact.weight),
                                   times_color(real, imaginary, color[1], impact.weight),
                                   times_color(real, imaginary, color[2], impact.weight)};
      add_color_row(parts, columns_.real() + first, columns_.imaginary() + first, count, out.row(0, y).data() + x,
                    out.row(1, y).data() + x, out.row(2, y).data() + x);
      return;
    }
    for (int c = 0; c < channels_; ++c) {
      add_row(times_color(real, imaginary, color[c], impact.weight), columns_.real() + first,
              columns_.imaginary() + first, count, out.row(c, y).data() + x);
    }
  }

  int channels_;
  const GaborBand& band_;
  GaborShape shape_;
  KernelPlaces rows_, columns_;
  std::vector<std::int32_t> shifted_;
};

}  // namespace

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
