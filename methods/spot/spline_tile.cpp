#include "methods/spot/spline_tile.h"

#include <utility>

namespace textonbench {
namespace {

/// Registers of floats, and the same anywhere in memory.
struct WideLine {
  static constexpr int lanes = 16;
  using Floats = float __attribute__((vector_size(lanes * sizeof(float)), may_alias));
  using Loose = float __attribute__((vector_size(lanes * sizeof(float)), aligned(alignof(float)), may_alias));
};
struct NarrowLine {
  static constexpr int lanes = 8;
  using Floats = float __attribute__((vector_size(lanes * sizeof(float)), may_alias));
  using Loose = float __attribute__((vector_size(lanes * sizeof(float)), aligned(alignof(float)), may_alias));
};

/// sum += weight line, rounded once, as the fused instruction of a processor that has it and by a function otherwise.
template <class Line, int... x>
[[gnu::always_inline]] inline void add_product(float weight, const typename Line::Floats& line,
                                               typename Line::Floats& sum, std::integer_sequence<int, x...>) {
  const auto w = typename Line::Floats{} + weight;
  const auto a = line;
  const auto b = sum;
  sum = typename Line::Floats{__builtin_fmaf(w[x], a[x], b[x])...};
}

/// sum(x) += left(x + column), `right` being what lies to the right of `left`.
template <class Line, int column, int... x>
[[gnu::always_inline]] inline void add_moved([[maybe_unused]] const typename Line::Floats& left,
                                             [[maybe_unused]] const typename Line::Floats& right,
                                             typename Line::Floats& sum, std::integer_sequence<int, x...>) {
  sum += __builtin_shufflevector(left, right, (column + x)...);
}

/// sum(x) += Σ_i left_i(x + i), i from 1 on.
template <class Line, int... i>
[[gnu::always_inline]] inline void add_all_moved([[maybe_unused]] const typename Line::Floats* left,
                                                 [[maybe_unused]] const typename Line::Floats* right,
                                                 [[maybe_unused]] typename Line::Floats& sum,
                                                 std::integer_sequence<int, i...>) {
  (add_moved<Line, i + 1>(left[i + 1], right[i + 1], sum, std::make_integer_sequence<int, Line::lanes>{}), ...);
}

/// Sums s_i(x, y) = Σ_visits wx_i g(x, y), 1 <= i <= n, of a block, where g(x, y) = Σ_j wy_j from(x, y + j).
template <int order, class Line, int height>
struct BlockSums {
  typename Line::Floats rows[height][order + 1] = {};
};

/// out(x, y) = start + Σ_i s_i(x + i, y), with s_i of the block and of `right`, the block to its right, which becomes
/// this one. As the weights of an axis have the sum 1, g = from_n + Σ_{j < n} wy_j (from_j − from_n) and
/// s_n = Σ_visits g − Σ_{i < n} s_i. So a visit takes, a row, one load, n + 1 additions and 2 n fused multiply-adds.
template <int order, class Line, int height>
[[gnu::always_inline]] inline void sum_block(std::span<const TileVisit> visits, std::ptrdiff_t offset,
                                             std::ptrdiff_t stride, float start, BlockSums<order, Line, height>& right,
                                             const TileRowOutput& out) {
  using Floats = typename Line::Floats;
  using Loose = typename Line::Loose;
  constexpr std::make_integer_sequence<int, Line::lanes> all{};
  Floats sums[height][order + 1] = {};
#pragma GCC unroll 16
  for (int y = 0; y < height; ++y) {
    sums[y][order] += start;
  }
  for (const TileVisit& visit : visits) {
    const float* from = visit.from + offset;
    const float* wx = visit.weights->x;
    const float* wy = visit.weights->y;
    Floats taps[order + 1];
#pragma GCC unroll 8
    for (int j = 0; j < order; ++j, from += stride) {
      taps[j] = *reinterpret_cast<const Loose*>(from);
    }
#pragma GCC unroll 16
    for (int y = 0; y < height; ++y, from += stride) {
      taps[order] = *reinterpret_cast<const Loose*>(from);
      Floats blend = taps[order];
#pragma GCC unroll 8
      for (int j = 0; j < order; ++j) {
        add_product<Line>(wy[j], taps[j] - taps[order], blend, all);
      }
#pragma GCC unroll 8
      for (int i = 0; i < order; ++i) {
        add_product<Line>(wx[i], blend, sums[y][i], all);
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
    for (int i = 0; i < order; ++i) {
      sums[y][order] -= sums[y][i];
    }
    Floats total = sums[y][0];
    add_all_moved<Line>(sums[y], right.rows[y], total, std::make_integer_sequence<int, order>{});
#pragma GCC unroll 8
    for (int i = 1; i <= order; ++i) {
      right.rows[y][i] = sums[y][i];
    }
    if (y < out.rows) {
      *reinterpret_cast<Floats*>(out.data + y * out.stride) = total;
    }
  }
}

/// Tile by tile from the right, each in blocks of a register of columns and `height` rows, whose sums fit the
/// registers.
template <int order, class Line, int height>
[[gnu::always_inline]] inline void sum_tiles_of(const TileRow& tiles, std::ptrdiff_t offset, float start,
                                                const TileRowOutput& out) {
  static_assert(tile_width % Line::lanes == 0 && tile_height(order) % height == 0 && order <= Line::lanes);
  for (int top = 0; top < tile_height(order); top += height) {
    BlockSums<order, Line, height> right;
    for (std::size_t i = tiles.first.size() - 1; i-- > 0;) {
      const auto visits = tiles.visits.subspan(tiles.first[i], tiles.first[i + 1] - tiles.first[i]);
      for (int left = tile_width - Line::lanes; left >= 0; left -= Line::lanes) {
        const std::ptrdiff_t x = static_cast<std::ptrdiff_t>(i) * tile_width + left;
        sum_block<order, Line, height>(
            visits, offset + top * tiles.stride + left, tiles.stride, start, right,
            {out.data + top * out.stride + x, out.stride, x < out.stride ? out.rows - top : 0});
      }
    }
  }
}

/// Tiles in blocks of one register across and a part of the rows.
template <class Line, int parts>
[[gnu::always_inline]] inline void sum_tiles_of(int order, const TileRow& tiles, std::ptrdiff_t offset, float start,
                                                const TileRowOutput& out) {
  switch (order) {
    case 0:
      return sum_tiles_of<0, Line, tile_height(0) / parts>(tiles, offset, start, out);
    case 1:
      return sum_tiles_of<1, Line, tile_height(1) / parts>(tiles, offset, start, out);
    case 2:
      return sum_tiles_of<2, Line, tile_height(2) / parts>(tiles, offset, start, out);
    case 3:
      return sum_tiles_of<3, Line, tile_height(3) / parts>(tiles, offset, start, out);
    case 4:
      return sum_tiles_of<4, Line, tile_height(4) / parts>(tiles, offset, start, out);
    default:
      return sum_tiles_of<5, Line, tile_height(5) / parts>(tiles, offset, start, out);
  }
}

__attribute__((target("avx512f"))) void sum_tiles_avx512(int order, const TileRow& tiles, std::ptrdiff_t offset,
                                                         float start, const TileRowOutput& out) {
  sum_tiles_of<WideLine, 1>(order, tiles, offset, start, out);
}

__attribute__((target("avx2,fma"))) void sum_tiles_avx2(int order, const TileRow& tiles, std::ptrdiff_t offset,
                                                        float start, const TileRowOutput& out) {
  sum_tiles_of<NarrowLine, 2>(order, tiles, offset, start, out);
}

}  // namespace

void sum_tiles(int order, const TileRow& tiles, std::ptrdiff_t offset, float start, const TileRowOutput& out) {
  if (__builtin_cpu_supports("avx512f")) {
    sum_tiles_avx512(order, tiles, offset, start, out);
  } else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    sum_tiles_avx2(order, tiles, offset, start, out);
  } else {
    sum_tiles_of<NarrowLine, 2>(order, tiles, offset, start, out);
  }
}

}  // namespace textonbench
