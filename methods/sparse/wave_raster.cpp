#include "methods/sparse/wave_raster.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "methods/base/aligned_buffer.h"
#include "methods/base/parallel.h"
#include "methods/sparse/wave_tile.h"

namespace textonbench {
namespace {

/// Side of a tile. Tiles are cut from the grid of all multiples of the step.
constexpr int tile_side = most_wave_columns;

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

/// The pixels [first, first + count) of a tile along an axis that a lattice point's window reaches, with their
/// distances from it.
struct TileReach {
  std::int64_t cell = 0;
  int first = 0;
  int count = 0;
  int middle = 0;  ///< of the pixels: the first that is not before the point
  /// From each pixel to the center: turns a bin, and the square in 2.25 squared spacings (1 beyond the last pixel).
  std::uint32_t turns[most_wave_columns + wave_surplus] = {};
  float squares[most_wave_columns + wave_surplus] = {};
};

/// Reaches of the lattice points `first` to `last` along an axis.
template <class Center>
std::vector<TileReach> reaches(const WaveField& field, const WaveLayer& layer, const std::vector<std::int64_t>& at,
                               std::int64_t first, std::int64_t last, const Center& center_of) {
  const std::int64_t reach = layer.spacing + layer.spacing / 2 + 1;
  std::vector<TileReach> all;
  for (std::int64_t cell = first; cell <= last; ++cell) {
    const std::int64_t center = center_of(cell);
    const auto begin = std::ranges::upper_bound(at, center - reach);
    const auto end = std::ranges::lower_bound(at, center + reach);
    if (begin >= end) continue;
    TileReach& one = all.emplace_back();
    one.cell = cell;
    one.first = static_cast<int>(begin - at.begin());
    one.count = static_cast<int>(end - begin);
    std::ranges::fill(one.squares, 1.0F);
    for (int i = 0; i < one.count; ++i) {
      const std::int64_t distance = begin[i] - center;
      const float d = static_cast<float>(distance) / static_cast<float>(layer.spacing);
      one.turns[i] = field.turns(distance);
      one.squares[i] = d * d * (1 / 2.25F);
      if (distance < 0) one.middle = i + 1;
    }
  }
  return all;
}

/// One tile, layer after layer.
class TileSum {
 public:
  TileSum(const WaveField& field, std::vector<std::int64_t> x, std::vector<std::int64_t> y)
      : field_(field),
        x_(std::move(x)),
        y_(std::move(y)),
        polynomial_(lrp_window_polynomial(field.window)),
        sum_(static_cast<std::size_t>((field.channels + 1) * tile_area + wave_surplus)) {}

  /// Sums a layer over the tile's cells.
  void sum_layer(const WaveLattice& lattice) {
    sum_.set_zero();
    const auto waves = static_cast<std::size_t>(lattice.layer().waves());
    reserve(waves);
    // A pixel's nine lattice points are next to its nearest one.
    const auto columns = reaches(field_, lattice.layer(), x_, lattice.nearest_x(x_.front()) - 1,
                                 lattice.nearest_x(x_.back()) + 1, [&](std::int64_t c) { return lattice.center_x(c); });
    const auto rows = reaches(field_, lattice.layer(), y_, lattice.nearest_y(y_.front()) - 1,
                              lattice.nearest_y(y_.back()) + 1, [&](std::int64_t c) { return lattice.center_y(c); });
    drawn_.resize(columns.size() * waves);
    for (const TileReach& row : rows) {
      draw_cells(lattice, columns, row.cell);
      // Rows are paired around the middle of those that the cell reaches.
      const std::int64_t low = y_[static_cast<std::size_t>(row.first)];
      const std::int64_t high = y_[static_cast<std::size_t>(row.first + row.count - 1)];
      const std::uint32_t middle = field_.turns(low + (high - low) / 2 - lattice.center_y(row.cell));
      apart_.clear();
      for (int p = 0; p < (row.count + 1) / 2; ++p) {
        const auto above = y_.begin() + row.first + row.count - 1 - p, below = y_.begin() + row.first + p;
        apart_.push_back(field_.turns((*above - *below) / 2));
      }
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto cell = std::span(drawn_).subspan(i * waves, waves);
        for (std::size_t j = 0; j < waves; ++j) {
          ky_[j] = cell[j].bin.ky;
          cell[j].phase += static_cast<std::uint32_t>(ky_[j]) * middle;
        }
        add_cell(cell, columns[i], row);
      }
    }
  }

  /// Row y of a channel of the layer's sum, and that of the squared windows.
  const float* sum(int channel, int y) const {
    return sum_.data() + channel * tile_area + std::ptrdiff_t{y} * tile_side;
  }
  const float* squares(int y) const { return sum(field_.channels, y); }

 private:
  static constexpr std::ptrdiff_t tile_area = std::ptrdiff_t{tile_side} * tile_side;

  /// Pairs of rows that are summed at a time, so that the sums stay in the first cache.
  static constexpr std::size_t pairs_at_once = 4;

  /// Room for a layer's cells.
  void reserve(std::size_t waves) {
    const std::size_t columns = std::size_t{tile_side} * static_cast<std::size_t>(field_.channels) + wave_line;
    const std::size_t padded = (waves + 7) / 8 * 8;
    for (auto [buffer, size] : {std::pair{&real_, columns * waves + wave_surplus},
                                {&imaginary_, columns * waves + wave_surplus},
                                {&rows_, pairs_at_once * 2 * padded},
                                {&above_, columns * pairs_at_once + wave_surplus},
                                {&below_, columns * pairs_at_once + wave_surplus}}) {
      *buffer = AlignedBuffer<float>(size);
      buffer->set_zero();
    }
    ky_.assign(padded, 0);
  }

  /// Waves of a row's cells, run by run of neighbors: at large steps pixels reach few of them.
  void draw_cells(const WaveLattice& lattice, const std::vector<TileReach>& columns, std::int64_t cy) {
    const auto waves = static_cast<std::size_t>(lattice.layer().waves());
    std::size_t end = 0;
    for (std::size_t first = 0; first < columns.size(); first = end) {
      for (end = first + 1; end < columns.size() && columns[end].cell == columns[end - 1].cell + 1;) ++end;
      lattice.draw(columns[first].cell, cy, std::span(drawn_).subspan(first * waves, (end - first) * waves));
    }
  }

  void add_cell(std::span<const Wave> waves, const TileReach& column, const TileReach& row) {
    const auto padded = static_cast<int>(ky_.size());
    // Channels follow each other without a gap, but where they are whole registers.
    const int stride = std::max(8, column.count);
    const int columns = (stride * field_.channels + wave_line - 1) / wave_line * wave_line;
    fill_wave_columns(waves, field_.channels, column.turns, column.count, stride, columns, real_.data(),
                      imaginary_.data());
    for (std::size_t p = 0; p < apart_.size(); p += pairs_at_once) {
      const auto pairs = std::span(apart_).subspan(p, std::min(pairs_at_once, apart_.size() - p));
      fill_wave_rows(ky_, pairs, rows_.data());
      sum_wave_rows({real_.data(), imaginary_.data(), columns, static_cast<int>(waves.size())}, rows_.data(),
                    2 * padded, padded, static_cast<int>(pairs.size()), above_.data(), below_.data());
      windowed_.clear();
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const int below = static_cast<int>(p + i), above = row.count - 1 - below;
        add_row(column, row, above, above_.data() + static_cast<std::ptrdiff_t>(i) * columns);
        if (below != above) add_row(column, row, below, below_.data() + static_cast<std::ptrdiff_t>(i) * columns);
      }
      add_windowed_rows(polynomial_, windowed_);
    }
  }

  void add_row(const TileReach& column, const TileReach& row, int y, const float* from) {
    // The columns that are within the window's disc: their squares fall to the middle and rise from there.
    const float most = 1 - row.squares[y];
    const float* middle = column.squares + column.middle;
    const auto first = static_cast<int>(
        std::partition_point(column.squares, middle, [most](float d) { return d >= most; }) - column.squares);
    const auto end = static_cast<int>(
        std::partition_point(middle, column.squares + column.count, [most](float d) { return d < most; }) -
        column.squares);
    if (first >= end) return;
    float* sum = sum_.data() + std::ptrdiff_t{row.first + y} * tile_side + column.first + first;
    windowed_.push_back({.distance_x = column.squares + first,
                         .distance_y = row.squares[y],
                         .count = end - first,
                         .channels = field_.channels,
                         .from = from + first,
                         .from_stride = std::max(8, column.count),
                         .sum = sum,
                         .sum_stride = tile_area,
                         .squares = sum + field_.channels * tile_area});
  }

  const WaveField& field_;
  std::vector<std::int64_t> x_, y_;
  const std::array<float, lrp_window_terms>& polynomial_;
  AlignedBuffer<float> sum_, real_, imaginary_, rows_, above_, below_;
  std::vector<Wave> drawn_;
  std::vector<std::int32_t> ky_;
  std::vector<std::uint32_t> apart_;
  std::vector<WindowedRow> windowed_;
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
