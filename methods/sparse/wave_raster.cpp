#include "methods/sparse/wave_raster.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/base/parallel.h"
#include "methods/sparse/wave_tile.h"

namespace textonbench {
namespace {

/// Side of a tile. Tiles are cut from the grid of all multiples of the step.
constexpr int tile_side = 64;

/// Coordinates of the pixels along an axis, in 2^−22 pixel; any index.
struct RasterAxis {
  double start;
  double step;
  std::int64_t number;  ///< of pixel 0 on the grid of the multiples of the step

  RasterAxis(double at, double by) : start(at), step(by), number(std::llround(at / by)) {}
  std::int64_t operator()(std::int64_t i) const {
    return static_cast<std::int64_t>(
        std::floor((start + step * static_cast<double>(i)) * static_cast<double>(std::int64_t{1} << plane_bits)));
  }
  /// Index of the first pixel of the tile that holds pixel i.
  std::int64_t tile_of(std::int64_t i) const {
    const std::int64_t n = number + i;
    return i - (n % tile_side + tile_side) % tile_side;
  }
};

/// Pixels [first, end) of a tile.
struct TileRange {
  int first = 0;
  int end = 0;
  int size() const { return end - first; }
};

/// The pixels of a tile whose distance from a center is less than `reach`.
TileRange within(const std::vector<std::int64_t>& at, std::int64_t center, std::int64_t reach) {
  const auto first = std::ranges::upper_bound(at, center - reach);
  const auto end = std::ranges::lower_bound(at, center + reach);
  return {static_cast<int>(first - at.begin()), static_cast<int>(end - at.begin())};
}

/// One tile, layer after layer.
class TileSum {
 public:
  TileSum(const WaveField& field, std::vector<std::int64_t> x, std::vector<std::int64_t> y)
      : field_(field),
        x_(std::move(x)),
        y_(std::move(y)),
        polynomial_(lrp_window_polynomial(field.window)),
        sum_(static_cast<std::size_t>(field.channels + 1) * tile_area) {}

  /// Sums a layer over the tile's cells.
  void sum_layer(const WaveLattice& lattice) {
    sum_.set_zero();
    const WaveLayer& layer = lattice.layer();
    const std::int64_t reach = layer.spacing + layer.spacing / 2 + 1;
    WaveCell cell(field_, layer);
    reserve(cell);
    // A pixel's nine lattice points are next to its nearest one.
    for (std::int64_t cy = lattice.nearest_y(y_.front()) - 1; cy <= lattice.nearest_y(y_.back()) + 1; ++cy) {
      const TileRange rows = within(y_, lattice.center_y(cy), reach);
      if (rows.size() <= 0) continue;
      for (std::int64_t cx = lattice.nearest_x(x_.front()) - 1; cx <= lattice.nearest_x(x_.back()) + 1; ++cx) {
        const TileRange columns = within(x_, lattice.center_x(cx), reach);
        if (columns.size() <= 0) continue;
        lattice.draw(cx, cy, cell);
        add_cell(cell, layer, {lattice.center_x(cx), lattice.center_y(cy)}, columns, rows);
      }
    }
  }

  /// Row y of a channel of the layer's sum, and that of the squared windows.
  const float* sum(int channel, int y) const { return sum_.data() + channel * tile_area + y * tile_side; }
  const float* squares(int y) const { return sum(field_.channels, y); }

 private:
  static constexpr std::ptrdiff_t tile_area = std::ptrdiff_t{tile_side} * tile_side;
  struct Center {
    std::int64_t x, y;
  };

  void reserve(const WaveCell& cell) {
    const auto columns = static_cast<std::size_t>(tile_side * field_.channels + wave_line);
    const auto waves = static_cast<std::size_t>(cell.padded);
    constexpr std::size_t pairs = tile_side / 2 + 1;
    real_ = AlignedBuffer<float>(columns * waves);
    imaginary_ = AlignedBuffer<float>(columns * waves);
    rows_ = AlignedBuffer<float>(pairs * 2 * waves);
    above_ = AlignedBuffer<float>(columns * pairs);
    below_ = AlignedBuffer<float>(columns * pairs);
    phase_.resize(waves);
  }

  void add_cell(const WaveCell& cell, const WaveLayer& layer, const Center& center, TileRange columns, TileRange rows) {
    // Rows are paired around the middle of those that the cell reaches.
    const std::int64_t low = y_[static_cast<std::size_t>(rows.first)];
    const std::int64_t high = y_[static_cast<std::size_t>(rows.end - 1)];
    const std::int64_t middle = low + (high - low) / 2;
    const int pairs = (rows.size() + 1) / 2;
    const std::uint32_t turn = field_.turns(middle - center.y);
    for (int j = 0; j < cell.waves; ++j) {
      phase_[static_cast<std::size_t>(j)] = cell.phase.data()[j] + static_cast<std::uint32_t>(cell.ky.data()[j]) * turn;
    }
    const int width = columns.size();
    for (int x = 0; x < width; ++x) {
      const std::int64_t d = x_[static_cast<std::size_t>(columns.first + x)] - center.x;
      turns_[x] = field_.turns(d);
      distance_x_[x] = squared_reaches(d, layer);
    }
    const int padded = (width * field_.channels + wave_line - 1) / wave_line * wave_line;
    fill_wave_columns(cell, field_.channels, phase_.data(), turns_, width, padded, real_.data(), imaginary_.data());
    for (int p = 0; p < pairs; ++p) {
      const std::int64_t d =
          y_[static_cast<std::size_t>(rows.end - 1 - p)] - y_[static_cast<std::size_t>(rows.first + p)];
      fill_wave_row(cell, field_.turns(d / 2), rows_.data() + p * 2 * cell.padded);
    }
    sum_wave_rows({real_.data(), imaginary_.data(), padded, cell.waves}, rows_.data(), 2 * cell.padded, cell.padded,
                  pairs, above_.data(), below_.data());
    for (int p = 0; p < pairs; ++p) {
      const int above = rows.end - 1 - p, below = rows.first + p;
      add_row(layer, center, columns, above, above_.data() + p * padded);
      if (below != above) add_row(layer, center, columns, below, below_.data() + p * padded);
    }
  }

  static float squared_reaches(std::int64_t distance, const WaveLayer& layer) {
    const float d = static_cast<float>(distance) / static_cast<float>(layer.spacing);
    return d * d * (1 / 2.25F);
  }

  void add_row(const WaveLayer& layer, const Center& center, TileRange columns, int y, const float* from) {
    const float distance_y = squared_reaches(y_[static_cast<std::size_t>(y)] - center.y, layer);
    // The part that is within the window's disc.
    int first = 0, end = columns.size();
    while (first < end && distance_x_[first] + distance_y >= 1) ++first;
    while (first < end && distance_x_[end - 1] + distance_y >= 1) --end;
    float* sum = sum_.data() + y * tile_side + columns.first + first;
    add_windowed_row(polynomial_, {.distance_x = distance_x_ + first,
                                   .distance_y = distance_y,
                                   .count = end - first,
                                   .channels = field_.channels,
                                   .from = from + first,
                                   .from_stride = columns.size(),
                                   .sum = sum,
                                   .sum_stride = tile_area,
                                   .squares = sum + field_.channels * tile_area});
  }

  const WaveField& field_;
  std::vector<std::int64_t> x_, y_;
  const std::array<float, lrp_window_terms>& polynomial_;
  AlignedBuffer<float> sum_, real_, imaginary_, rows_, above_, below_;
  std::vector<std::uint32_t> phase_;
  alignas(64) std::uint32_t turns_[tile_side] = {};
  alignas(64) float distance_x_[tile_side] = {};
};

std::vector<std::int64_t> coordinates(const RasterAxis& axis, std::int64_t first) {
  std::vector<std::int64_t> all;
  all.reserve(tile_side);
  for (int i = 0; i < tile_side; ++i) all.push_back(axis(first + i));
  return all;
}

}  // namespace

void add_waves(const WaveField& field, Seed seed, const WaveRaster& raster, Image& out) {
  const RasterAxis horizontal(raster.x, raster.step), vertical(raster.y, raster.step);
  std::vector<WaveLattice> lattices;
  lattices.reserve(field.layers.size());
  for (std::size_t l = 0; l < field.layers.size(); ++l) lattices.emplace_back(field, l, seed);
  const std::int64_t left = horizontal.tile_of(0), top = vertical.tile_of(0);
  const auto across = static_cast<int>((out.width() - left + tile_side - 1) / tile_side);
  const auto down = static_cast<int>((out.height() - top + tile_side - 1) / tile_side);
  parallel_for(across * down, [&](int tile) {
    const std::int64_t x0 = left + std::int64_t{tile % across} * tile_side;
    const std::int64_t y0 = top + std::int64_t{tile / across} * tile_side;
    TileSum sums(field, coordinates(horizontal, x0), coordinates(vertical, y0));
    const auto first = static_cast<int>(std::max<std::int64_t>(0, -x0));
    const auto end = static_cast<int>(std::min<std::int64_t>(tile_side, out.width() - x0));
    for (const WaveLattice& lattice : lattices) {
      sums.sum_layer(lattice);
      for (int y = 0; y < tile_side; ++y) {
        if (y0 + y < 0 || y0 + y >= out.height()) continue;
        const float* squares = sums.squares(y);
        for (int c = 0; c < field.channels; ++c) {
          const float* from = sums.sum(c, y);
          float* to = out.row(c, static_cast<int>(y0 + y)).data() + x0;
          for (int x = first; x < end; ++x) to[x] += field.even_variance ? from[x] / std::sqrt(squares[x]) : from[x];
        }
      }
    }
  });
}

}  // namespace textonbench
