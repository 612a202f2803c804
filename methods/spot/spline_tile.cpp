#include "methods/spot/spline_tile.h"

#include <utility>

namespace textonbench {
namespace {

using TileLine = float __attribute__((vector_size(tile_width * sizeof(float)), may_alias));
using LooseLine = float __attribute__((vector_size(tile_width * sizeof(float)), aligned(alignof(float)), may_alias));
using LineIndex = int __attribute__((vector_size(tile_width * sizeof(int))));
/// sum += weight line, rounded once, as the fused instruction of a processor that has it and by a function otherwise.
template <int... x>
[[gnu::always_inline]] inline void add_product(float weight, const TileLine& line, TileLine& sum,
                                               std::integer_sequence<int, x...>) {
  const TileLine w = TileLine{} + weight;
  const TileLine a = line;
  const TileLine b = sum;
  sum = TileLine{__builtin_fmaf(w[x], a[x], b[x])...};
}
[[gnu::always_inline]] inline void add_product(float weight, const TileLine& line, TileLine& sum) {
  add_product(weight, line, sum, std::make_integer_sequence<int, tile_width>{});
}

/// Sums s_i(x, y) = Σ_visits wx_i g(x, y), 1 <= i <= n, of a tile, where g(x, y) = Σ_j wy_j from(x, y + j).
template <int order>
struct TileSums {
  TileLine rows[tile_height(order)][order + 1] = {};
};

/// out(x, y) = start + Σ_i s_i(x + i, y), with s_i of the tile and of `right`, the tile to its right, which becomes
/// this one. As the weights of an axis have the sum 1, g = from_n + Σ_{j < n} wy_j (from_j − from_n) and s_n = Σ_visits
/// g − Σ_{i < n} s_i. So a visit takes, a row, one load, n + 1 additions and 2 n fused multiply-adds.
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
      TileLine blend = taps[order];
#pragma GCC unroll 8
      for (int j = 0; j < order; ++j) {
        add_product(wy[j], taps[j] - taps[order], blend);
      }
#pragma GCC unroll 8
      for (int i = 0; i < order; ++i) {
        add_product(wx[i], blend, sums[y][i]);
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
                                                const TileRowOutput& out) {
  TileSums<order> right;
  for (std::size_t i = tiles.first.size() - 1; i-- > 0;) {
    const auto x = static_cast<std::ptrdiff_t>(i) * tile_width;
    const auto visits = tiles.visits.subspan(tiles.first[i], tiles.first[i + 1] - tiles.first[i]);
    sum_tile<order>(visits, offset, tiles.stride, start, right,
                    {out.data + x, out.stride, x < out.stride ? out.rows : 0});
  }
}

}  // namespace

__attribute__((target_clones("default", "arch=x86-64-v3", "avx512f"))) void sum_tiles(int order, const TileRow& tiles,
                                                                                      std::ptrdiff_t offset,
                                                                                      float start,
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
