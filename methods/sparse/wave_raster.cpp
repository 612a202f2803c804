#include "methods/sparse/wave_raster.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "methods/base/parallel.h"
#include "methods/sparse/wave_tile.h"

namespace textonbench {
namespace {

constexpr int tile_side = wave_tile_side;

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
  /// Index of the first pixel of the tile that holds pixel i. Tiles are cut from the grid of all multiples of the step.
  std::int64_t tile_of(std::int64_t i) const {
    const std::int64_t n = number + i;
    return i - (n % tile_side + tile_side) % tile_side;
  }
};

/// What all tiles of a column, or of a row, have in common.
struct AxisTile {
  std::vector<std::int64_t> at;  ///< the pixels' coordinates
  std::shared_ptr<const std::vector<WaveTable>> tables;
};

/// The tiles of an axis that cover `pixels` of it. Neighbors whose pixels are as far from each other share what
/// `make_tables` makes of them: on a raster whose step is whole, all.
template <class Tables>
std::vector<AxisTile> cut_axis(const RasterAxis& axis, int pixels, const Tables& make_tables) {
  std::vector<AxisTile> tiles;
  for (std::int64_t first = axis.tile_of(0); first < pixels; first += tile_side) {
    AxisTile tile;
    for (int i = 0; i < tile_side; ++i) tile.at.push_back(axis(first + i));
    const auto as_far = [&](const AxisTile& other) {
      return std::ranges::equal(
          tile.at, other.at, {}, [&](std::int64_t x) { return x - tile.at.front(); },
          [&](std::int64_t x) { return x - other.at.front(); });
    };
    tile.tables = !tiles.empty() && as_far(tiles.back())
                      ? tiles.back().tables
                      : std::make_shared<const std::vector<WaveTable>>(make_tables(tile.at));
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

/// Tables of the bins that a field has: along a tile's columns, and at the rows of pairs.
class TableMaker {
 public:
  explicit TableMaker(const WaveField& field) : field_(field) {
    for (const WaveLayer& layer : field.layers) {
      for (const WaveBin& bin : layer.bins) {
        least_ = {std::min(least_.kx, bin.kx), std::min(least_.ky, bin.ky)};
        most_ = {std::max(most_.kx, bin.kx), std::max(most_.ky, bin.ky)};
      }
    }
  }

  std::vector<WaveTable> of_columns(const std::vector<std::int64_t>& x) const {
    std::vector<std::uint32_t> turns;
    turns.reserve(x.size());
    for (const std::int64_t one : x) turns.push_back(field_.turns(one - x.front()));
    return {WaveTable(least_.kx, most_.kx, turns)};
  }
  /// Number 0 of an even number of rows, whose pairs are half a step from the middle, and so on; number 1 of an odd
  /// one.
  std::vector<WaveTable> of_pairs(const std::vector<std::int64_t>& y) const {
    std::vector<WaveTable> tables;
    for (const std::size_t apart : {1U, 0U}) {
      std::vector<std::uint32_t> turns;
      for (std::size_t i = apart; i < y.size(); i += 2) turns.push_back(field_.turns((y[i] - y.front()) / 2));
      tables.emplace_back(least_.ky, most_.ky, turns);
    }
    return tables;
  }

 private:
  const WaveField& field_;
  WaveBin least_, most_;
};

/// The pixels of a tile that the windows of the lattice points `first` to `last` reach along an axis.
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
    one.turns = field.turns(at.front() - center);
    for (int i = 0; i < one.count; ++i) {
      const std::int64_t distance = begin[i] - center;
      const float d = static_cast<float>(distance) / static_cast<float>(layer.spacing);
      one.squares[i] = d * d * (1 / 2.25F);
      if (distance < 0) one.middle = i + 1;
    }
    std::fill(one.squares + one.count, std::end(one.squares), 1.0F);
  }
  return all;
}

TilePairs pair_rows(const WaveField& field, const TileReach& rows, const AxisTile& axis, std::int64_t center) {
  TilePairs pairs;
  pairs.count = (rows.count + 1) / 2;
  pairs.waves = &(*axis.tables)[static_cast<std::size_t>(rows.count % 2)];
  const std::int64_t low = axis.at[static_cast<std::size_t>(rows.first)];
  const std::int64_t high = axis.at[static_cast<std::size_t>(rows.first + rows.count - 1)];
  pairs.turns = field.turns(low + (high - low) / 2 - center);
  for (int p = 0; p < pairs.count; ++p) {
    const int after = rows.count / 2 + p, before = rows.count - 1 - after;
    pairs.row[0][p] = rows.first + after;
    pairs.row[1][p] = rows.first + before;
    pairs.rest[0][p] = 1 - rows.squares[after];
    pairs.rest[1][p] = after == before ? 0 : 1 - rows.squares[before];
  }
  // Registers of two pairs may hold one more.
  pairs.row[0][pairs.count] = pairs.row[1][pairs.count] = wave_tile_side;
  return pairs;
}

/// Sums a layer over a tile's cells.
void sum_layer(const WaveField& field, const WaveLattice& lattice, const LayerColors& colors, const AxisTile& x,
               const AxisTile& y, const TileSums& sums) {
  const auto& polynomial = lrp_window_polynomial(field.window);
  DrawnWaves drawn;
  CellRoom room(static_cast<std::size_t>(lattice.layer().waves()), colors, field.channels);
  // A pixel's nine lattice points are next to its nearest one.
  const auto columns = reaches(field, lattice.layer(), x.at, lattice.nearest_x(x.at.front()) - 1,
                               lattice.nearest_x(x.at.back()) + 1, [&](std::int64_t c) { return lattice.center_x(c); });
  const auto rows = reaches(field, lattice.layer(), y.at, lattice.nearest_y(y.at.front()) - 1,
                            lattice.nearest_y(y.at.back()) + 1, [&](std::int64_t c) { return lattice.center_y(c); });
  for (const TileReach& row : rows) {
    const TilePairs pairs = pair_rows(field, row, y, lattice.center_y(row.cell));
    // Run by run of neighbors: at large steps pixels reach few cells.
    std::size_t end = 0;
    for (std::size_t first = 0; first < columns.size(); first = end) {
      for (end = first + 1; end < columns.size() && columns[end].cell == columns[end - 1].cell + 1;) ++end;
      lattice.draw(columns[first].cell, row.cell, end - first, drawn);
      for (std::size_t i = first; i < end; ++i) {
        add_cell(polynomial, {colors, drawn, i - first}, x.tables->front(), columns[i], pairs, room, sums);
      }
    }
  }
}

}  // namespace

void add_waves(const WaveField& field, Seed seed, const WaveRaster& raster, Image& out) {
  std::vector<WaveLattice> lattices;
  std::vector<LayerColors> colors;
  for (std::size_t l = 0; l < field.layers.size(); ++l) {
    lattices.emplace_back(field, l, seed);
    colors.emplace_back(field.layers[l], field.channels);
  }
  const RasterAxis horizontal(raster.x, raster.step), vertical(raster.y, raster.step);
  const std::int64_t left = horizontal.tile_of(0), top = vertical.tile_of(0);
  const TableMaker maker(field);
  const auto columns = cut_axis(horizontal, out.width(), [&](const auto& x) { return maker.of_columns(x); });
  const auto rows = cut_axis(vertical, out.height(), [&](const auto& y) { return maker.of_pairs(y); });
  const auto across = static_cast<int>(columns.size());
  parallel_for(across * static_cast<int>(rows.size()), [&](int tile) {
    const int column = tile % across, row = tile / across;
    const std::int64_t x0 = left + std::int64_t{column} * tile_side, y0 = top + std::int64_t{row} * tile_side;
    const auto first = static_cast<int>(std::max<std::int64_t>(0, -x0));
    const auto end = static_cast<int>(std::min<std::int64_t>(tile_side, out.width() - x0));
    TileSums sums(field.channels);
    float scale[tile_side];
    std::ranges::fill(scale, 1.0F);
    for (std::size_t l = 0; l < lattices.size(); ++l) {
      sums.set_zero();
      sum_layer(field, lattices[l], colors[l], columns[static_cast<std::size_t>(column)],
                rows[static_cast<std::size_t>(row)], sums);
      for (int y = 0; y < tile_side; ++y) {
        if (y0 + y < 0 || y0 + y >= out.height()) continue;
        if (field.even_variance) invert_roots(sums.row(field.channels, y), tile_side, scale);
        for (int c = 0; c < field.channels; ++c) {
          const float* from = sums.row(c, y);
          float* to = out.row(c, static_cast<int>(y0 + y)).data() + x0;
          for (int x = first; x < end; ++x) to[x] += from[x] * scale[x];
        }
      }
    }
  });
}

}  // namespace textonbench
