#include "methods/spot/spline_tile.h"

#include <algorithm>
#include <utility>

namespace textonbench {
namespace {

using TileLine = float __attribute__((vector_size(tile_width * sizeof(float)), may_alias));
using LooseLine = float __attribute__((vector_size(tile_width * sizeof(float)), aligned(alignof(float)), may_alias));
using LineIndex = int __attribute__((vector_size(tile_width * sizeof(int))));

/// Sums s_i(x, y) = Σ_visits wx_i g(x, y), 1 <= i <= n, of a tile, where g(x, y) = Σ_j wy_j from(x, y + j).
template <int order>
struct TileSums {
  TileLine rows[tile_height(order)][order + 1] = {};
};

/// out(x, y) = start + Σ_i s_i(x + i, y), with s_i of the tile and of `right`, the tile to its right, which becomes this
/// one. As Σ_i wx_i = 1, s_n = Σ_visits g − Σ_{i < n} s_i: a visit takes 2 n + 1 multiplications, as many additions, and
/// one load a row.
template <int order>
[[gnu::always_inline]] inline void sum_tile(std::span<const TileVisit> visits, std::ptrdiff_t offset,
                                            std::ptrdiff_t stride, float start, TileSums<order>& right,
                                            const TileRowOutput& out) {
  constexpr int height = tile_height(order);
  TileLine sums[height][order + 1] = {};
#pragma GCC unroll 16
  for (int y = 0; y < height; ++y) {
    sums[y][order] += start;
  }
  for (const TileVisit& visit : visits) {
    const float* from = visit.from + offset;
    const float* wx = visit.weights->x;
    const float* wy = visit.weights->y;
    TileLine taps[order + 1];
#pragma GCC unroll 8
    for (int j = 0; j < order; ++j, from += stride) {
      taps[j] = *reinterpret_cast<const LooseLine*>(from);
    }
#pragma GCC unroll 16
    for (int y = 0; y < height; ++y, from += stride) {
      taps[order] = *reinterpret_cast<const LooseLine*>(from);
      TileLine blend = wy[0] * taps[0];
#pragma GCC unroll 8
      for (int j = 1; j <= order; ++j) {
        blend += wy[j] * taps[j];
      }
#pragma GCC unroll 8
      for (int i = 0; i < order; ++i) {
        sums[y][i] += wx[i] * blend;
      }
      sums[y][order] += blend;
#pragma GCC unroll 8
      for (int j = 0; j < order; ++j) {
        taps[j] = taps[j + 1];
      }
    }
  }
  const LineIndex columns = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
#pragma GCC unroll 16
  for (int y = 0; y < height; ++y) {
#pragma GCC unroll 8
    for (int i = 0; i < order; ++i) {
      sums[y][order] -= sums[y][i];
    }
    TileLine total = sums[y][0];
#pragma GCC unroll 8
    for (int i = 1; i <= order; ++i) {
      total += __builtin_shuffle(sums[y][i], right.rows[y][i], columns + i);
      right.rows[y][i] = sums[y][i];
    }
    if (y < out.rows) {
      *reinterpret_cast<TileLine*>(out.data + y * out.stride) = total;
    }
  }
}

template <int order>
[[gnu::always_inline]] inline void sum_tiles_of(const TileRow& tiles, std::ptrdiff_t offset, float start,
                                                TileRowOutput out) {
  TileSums<order> right;
  std::size_t i = tiles.first.size() - 1;
  out.data += static_cast<std::ptrdiff_t>(i) * tile_width;
  for (; i > 0; --i) {
    out.data -= tile_width;
    const std::size_t first = tiles.first[i - 1];
    sum_tile<order>(tiles.visits.subspan(first, tiles.first[i] - first), offset, tiles.stride, start, right, out);
  }
}

}  // namespace

__attribute__((target_clones("default", "avx2", "avx512f"))) void sum_tiles(int order, const TileRow& tiles,
                                                                            std::ptrdiff_t offset, float start,
                                                                            const TileRowOutput& out) {
  switch (order) {
    case 0:
      return sum_tiles_of<0>(tiles, offset, start, out);
    case 1:
      return sum_tiles_of<1>(tiles, offset, start, out);
    case 2:
      return sum_tiles_of<2>(tiles, offset, start, out);
    case 3:
      return sum_tiles_of<3>(tiles, offset, start, out);
    case 4:
      return sum_tiles_of<4>(tiles, offset, start, out);
    default:
      return sum_tiles_of<5>(tiles, offset, start, out);
  }
}

}  // namespace textonbench
