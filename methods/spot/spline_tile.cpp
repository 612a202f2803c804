#include "methods/spot/spline_tile.h"

#include <algorithm>
#include <utility>

namespace textonbench {
namespace {

using TileLine = float __attribute__((vector_size(tile_width * sizeof(float)), may_alias));
using LooseLine = float __attribute__((vector_size(tile_width * sizeof(float)), aligned(alignof(float)), may_alias));

/// Sums of two tiles side by side: s_i(x, y) = Σ_visits wx_i g(x, y) for i < n, and s_n = Σ_visits g, where
/// g(x, y) = Σ_j wy_j from(x, y + j).
template <int order>
struct TileSums {
  alignas(64) float rows[tile_height(order)][order + 1][2 * tile_width] = {};
};

/// Sums of a tile, to the right-hand side. One load, and 2 n + 1 multiplications and additions a row and visit.
template <int order>
[[gnu::always_inline]] inline void sum_visits(std::span<const TileVisit> visits, std::ptrdiff_t offset,
                                              std::ptrdiff_t stride, float start, TileSums<order>& to) {
  constexpr int height = tile_height(order);
  TileLine sums[height][order + 1];
#pragma GCC unroll 16
  for (int y = 0; y < height; ++y) {
#pragma GCC unroll 8
    for (int i = 0; i < order; ++i) {
      sums[y][i] = TileLine{};
    }
    sums[y][order] = TileLine{} + start;
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
#pragma GCC unroll 16
  for (int y = 0; y < height; ++y) {
#pragma GCC unroll 8
    for (int i = 0; i <= order; ++i) {
      *reinterpret_cast<TileLine*>(to.rows[y][i] + tile_width) = sums[y][i];
    }
  }
}

/// The weights along x have the sum 1: Σ_i wx_i g(x + i) = g(x + n) + Σ_{i < n} wx_i (g(x + i) − g(x + n)), of the left
/// tile.
template <int order>
[[gnu::always_inline]] inline void blend_sums(const TileSums<order>& sums, const TileRowOutput& out) {
  
  for (int y = 0; y < out.rows; ++y) {
    TileLine blend = *reinterpret_cast<const LooseLine*>(sums.rows[y][order] + order);
    for (int i = 0; i < order; ++i) {
      blend += *reinterpret_cast<const LooseLine*>(sums.rows[y][i] + i) - *reinterpret_cast<const LooseLine*>(sums.rows[y][i] + order);
    }
    *reinterpret_cast<TileLine*>(out.data + y * out.stride) = blend;
  }
}

template <int order>
[[gnu::always_inline]] inline void sum_tiles_of(const TileRow& tiles, std::ptrdiff_t offset, float start,
                                                TileRowOutput out) {
  TileSums<order> sums;
  for (std::size_t i = 0; i + 1 < tiles.first.size(); ++i) {
    for (auto& row : sums.rows) {
      for (float* sum : row) {
        *reinterpret_cast<TileLine*>(sum) = *reinterpret_cast<TileLine*>(sum + tile_width);
      }
    }
    sum_visits<order>(tiles.visits.subspan(tiles.first[i], tiles.first[i + 1] - tiles.first[i]), offset, tiles.stride,
                      start, sums);
    if (i > 0) {
      blend_sums<order>(sums, out);
      out.data += tile_width;
    }
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
