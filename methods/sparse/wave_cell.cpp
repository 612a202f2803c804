#include <algorithm>
#include <cmath>
#include <utility>

#include "methods/sparse/wave_lanes.h"
#include "methods/sparse/wave_tile.h"

// Vectors are returned by functions that are always inlined, where no calling convention matters.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace textonbench {
namespace {

/// The arguments of add_cell.
struct AddCell {
  const std::array<float, lrp_window_terms>& polynomial;
  const CellWaves& waves;
  const WaveTable& table;
  const TileReach& columns;
  const TilePairs& pairs;
  CellRoom& room;
  const TileSums& sums;
};

/// a b + c, rounded once: the fused instruction of a processor that has it, a function otherwise.
template <class Lanes, int... x>
[[gnu::always_inline]] inline void fuse(const typename Lanes::Floats& a, const typename Lanes::Floats& b,
                                        typename Lanes::Floats& c, std::integer_sequence<int, x...>) {
  const auto p = a;
  const auto q = b;
  const auto r = c;
  c = typename Lanes::Floats{__builtin_fmaf(p[x], q[x], r[x])...};
}

/// c + a b.
template <class Lanes>
[[gnu::always_inline]] inline typename Lanes::Floats fused(const typename Lanes::Floats& a,
                                                           const typename Lanes::Floats& b,
                                                           const typename Lanes::Floats& c) {
  auto sum = c;
  fuse<Lanes>(a, b, sum, std::make_integer_sequence<int, Lanes::count>{});
  return sum;
}

template <class Lanes>
[[gnu::always_inline]] inline typename Lanes::Floats load(const float* from) {
  return *reinterpret_cast<const typename Lanes::LooseFloats*>(from);
}

/// Registers of a row each (fold = 1), or of two rows of half as many columns (fold = 2).
template <class L, int f>
struct Fold {
  using Lanes = L;
  using Floats = typename Lanes::Floats;
  static constexpr int fold = f;
  static constexpr int columns = Lanes::count / fold;

  /// from[x] in column x of all rows.
  [[gnu::always_inline]] static Floats along_columns(const float* from) {
    if constexpr (fold == 1) {
      return load<Lanes>(from);
    } else {
      const Floats v = load<Lanes>(from);
      return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7);
    }
  }
  /// from[i] in all of row i.
  [[gnu::always_inline]] static Floats along_rows(const float* from) {
    if constexpr (fold == 1) {
      return *from - Floats{};
    } else {
      const Floats v = load<Lanes>(from);
      return __builtin_shufflevector(v, v, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1);
    }
  }
  /// from[i] - line in all of row i. Of a number and a vector, which compiles better than of the number's vector.
  [[gnu::always_inline]] static Floats less(const float* from, const Floats& line) {
    if constexpr (fold == 1) {
      return *from - line;
    } else {
      return along_rows(from) - line;
    }
  }
  /// to[i][x] += a b of row i and column x.
  [[gnu::always_inline]] static void add_product(const Floats& a, const Floats& b, float* const (&to)[fold],
                                                 std::ptrdiff_t offset) {
    if constexpr (fold == 1) {
      *reinterpret_cast<typename Lanes::LooseFloats*>(to[0] + offset) = load<Lanes>(to[0] + offset) + a * b;
    } else {
      const auto upper = load<EightLanes>(to[0] + offset), lower = load<EightLanes>(to[1] + offset);
      const Floats sum =
          __builtin_shufflevector(upper, lower, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) + a * b;
      *reinterpret_cast<EightLanes::LooseFloats*>(to[0] + offset) =
          __builtin_shufflevector(sum, sum, 0, 1, 2, 3, 4, 5, 6, 7);
      *reinterpret_cast<EightLanes::LooseFloats*>(to[1] + offset) =
          __builtin_shufflevector(sum, sum, 8, 9, 10, 11, 12, 13, 14, 15);
    }
  }
};

/// The window by 1 less the squared distance.
template <class Lanes>
[[gnu::always_inline]] inline typename Lanes::Floats window_at(const std::array<float, lrp_window_terms>& k,
                                                               const typename Lanes::Floats& rest) {
  using Floats = typename Lanes::Floats;
  static_assert(lrp_window_terms == 9);
  const Floats t = rest > 0 ? rest : Floats{};
  Floats root, p;
  for (int x = 0; x < Lanes::count; ++x) {
    const float v = t[x], v2 = v * v, v4 = v2 * v2;
    root[x] = std::sqrt(v);
    const float low = __builtin_fmaf(__builtin_fmaf(k[3], v, k[2]), v2, __builtin_fmaf(k[1], v, k[0]));
    const float high = __builtin_fmaf(__builtin_fmaf(k[7], v, k[6]), v2, __builtin_fmaf(k[5], v, k[4]));
    p[x] = __builtin_fmaf(__builtin_fmaf(k[8], v4, high), v4, low);
  }
  return t * root * p;
}

/// The columns of one register: where they begin, and their squared distances with a lower bound.
template <class F>
struct Chunk {
  int first;  ///< of the cell's columns
  float nearest;
  typename F::Floats squares;
};

/// Adds `height` registers of pairs from `pair` on and `width` channels from `channel` on, whose sums stay in
/// registers.
template <class F, int height, int width>
[[gnu::always_inline]] inline void add_block(const AddCell& cell, const Chunk<F>& chunk, int pair, int channel) {
  using Lanes = typename F::Lanes;
  using Floats = typename F::Floats;
  const TilePairs& pairs = cell.pairs;
  float most = 0;
#pragma GCC unroll 8
  for (int p = pair; p < pair + height * F::fold; ++p) most = std::max({most, pairs.rest[0][p], pairs.rest[1][p]});
  if (most <= chunk.nearest) return;
  Floats even[height][width] = {}, odd[height][width] = {};
  const std::ptrdiff_t stride = std::ptrdiff_t{cell.sums.channels()} * 2 * Lanes::count;
  const float* z = cell.room.products.data() + std::ptrdiff_t{channel} * 2 * Lanes::count;
  const int sines = pairs.waves->sines();
  const float* const* rows = cell.room.rows.data();
  const std::size_t waves = cell.room.rows.size();
  for (std::size_t j = 0; j < waves; ++j, z += stride) {
    const float* row = rows[j] + pair;
    Floats re[width], im[width];
#pragma GCC unroll 8
    for (int i = 0; i < width; ++i) {
      re[i] = load<Lanes>(z + 2 * i * Lanes::count);
      im[i] = load<Lanes>(z + (2 * i + 1) * Lanes::count);
    }
#pragma GCC unroll 8
    for (int p = 0; p < height; ++p) {
      const Floats cosine = F::along_rows(row + p * F::fold);
      const Floats sine = F::along_rows(row + sines + p * F::fold);
#pragma GCC unroll 8
      for (int i = 0; i < width; ++i) {
        even[p][i] = fused<Lanes>(cosine, re[i], even[p][i]);
        odd[p][i] = fused<Lanes>(sine, im[i], odd[p][i]);
      }
    }
  }
  // Copies, since stores of vectors might change anything else.
  const std::ptrdiff_t row_stride = cell.sums.row_stride(),
                       squares = cell.sums.row(cell.sums.channels(), 0) - cell.sums.row(0, 0);
  float* const sums = cell.sums.row(channel, 0) + cell.columns.first + chunk.first;
#pragma GCC unroll 8
  for (int p = 0; p < height; ++p) {
#pragma GCC unroll 2
    for (int side = 0; side < 2; ++side) {
      const int at = pair + p * F::fold;
      if (std::max(pairs.rest[side][at], pairs.rest[side][at + F::fold - 1]) <= chunk.nearest) continue;
      float* to[F::fold];
      for (int r = 0; r < F::fold; ++r) to[r] = sums + pairs.row[side][at + r] * row_stride;
      const Floats window = window_at<Lanes>(cell.polynomial, F::less(&pairs.rest[side][at], chunk.squares));
#pragma GCC unroll 8
      for (int i = 0; i < width; ++i) {
        const Floats value = side == 0 ? even[p][i] - odd[p][i] : even[p][i] + odd[p][i];
        F::add_product(window, value, to, std::ptrdiff_t{i} * TileSums::channel_stride);
      }
      if (channel == 0) F::add_product(window, window, to, squares);
    }
  }
}

template <class F, int height, int width>
[[gnu::always_inline]] inline void add_channels(const AddCell& cell, const Chunk<F>& chunk, int channel) {
  int pair = 0;
  for (; pair + height * F::fold <= cell.pairs.count; pair += height * F::fold) {
    add_block<F, height, width>(cell, chunk, pair, channel);
  }
  for (; pair < cell.pairs.count; pair += F::fold) add_block<F, 1, width>(cell, chunk, pair, channel);
}

/// Adds the columns of one register, from `first` on of the cell's.
template <class F, int height>
[[gnu::always_inline]] inline void add_chunk(const AddCell& cell, int first) {
  using Lanes = typename F::Lanes;
  using Floats = typename F::Floats;
  const TileReach& columns = cell.columns;
  const int last = std::min(first + F::columns, columns.count) - 1;
  Chunk<F> chunk{first, 0, F::along_columns(columns.squares + first)};
  if (columns.middle <= first) chunk.nearest = columns.squares[first];
  if (columns.middle > last) chunk.nearest = columns.squares[last];
  const int channels = cell.sums.channels();
  float* z = cell.room.products.data();
  const float* const* along = cell.room.columns.data();
  const float* colors = cell.room.colors.data();
  const std::size_t waves = cell.room.columns.size(), stride = cell.waves.colors.stride();
  const int sines = cell.table.sines();
  for (std::size_t j = 0; j < waves; ++j, colors += stride) {
    const Floats cosine = F::along_columns(along[j] + first), sine = F::along_columns(along[j] + sines + first);
    const float* color = colors;
    for (int c = 0; c < channels; ++c, color += 2, z += 2 * Lanes::count) {
      const float re = color[0], im = color[1];
      *reinterpret_cast<Floats*>(z) = re * cosine - im * sine;
      *reinterpret_cast<Floats*>(z + Lanes::count) = re * sine + im * cosine;
    }
  }
  int channel = 0;
  for (; channel + 3 <= channels; channel += 3) add_channels<F, height, 3>(cell, chunk, channel);
  for (; channel < channels; ++channel) add_channels<F, height, 1>(cell, chunk, channel);
}

/// Colors and table rows of the waves.
[[gnu::always_inline]] inline void prepare(const AddCell& cell) {
  using Lanes = EightLanes;
  using Floats = Lanes::Floats;
  using Words = Lanes::LooseWords;
  const DrawnWaves& drawn = cell.waves.drawn;
  CellRoom& room = cell.room;
  const std::size_t at = cell.waves.cell * drawn.padded;
  const std::int32_t* kx = drawn.kx.data() + at;
  const std::int32_t* ky = drawn.ky.data() + at;
  const std::uint32_t* phase = drawn.phase.data() + at;
  for (std::size_t j = 0; j < drawn.padded; j += Lanes::count) {
    const Lanes::Words turns = *reinterpret_cast<const Words*>(phase + j) +
                               *reinterpret_cast<const Words*>(kx + j) * cell.columns.turns +
                               *reinterpret_cast<const Words*>(ky + j) * cell.pairs.turns;
    cos_sin_lanes<Lanes>(turns, *reinterpret_cast<Floats*>(room.cosines.data() + j),
                         *reinterpret_cast<Floats*>(room.sines.data() + j));
  }
  const float** columns = room.columns.data();
  const float** rows = room.rows.data();
  const std::size_t waves = room.rows.size(), stride = cell.waves.colors.stride();
  const std::uint32_t* number = drawn.color.data() + at;
  const WaveTable& along = cell.table;
  const WaveTable& across = *cell.pairs.waves;
  const float* cosines = room.cosines.data();
  const float* sines = room.sines.data();
  float* to = room.colors.data();
  for (std::size_t j = 0; j < waves; ++j) {
    columns[j] = along.cosines(kx[j]) + cell.columns.first;
    rows[j] = across.cosines(ky[j]);
    const float* color = cell.waves.colors.at(number[j]);
    const float cosine = cosines[j], sine = sines[j];
    for (std::size_t i = 0; i < stride; i += Lanes::count, to += Lanes::count) {
      const Floats z = *reinterpret_cast<const Floats*>(color + i);
      const Floats turned = __builtin_shufflevector(z, z, 1, 0, 3, 2, 5, 4, 7, 6) * Floats{-1, 1, -1, 1, -1, 1, -1, 1};
      *reinterpret_cast<Floats*>(to) = cosine * z + sine * turned;
    }
  }
}

__attribute__((target("avx512f,avx512vl,avx512dq"))) void add_cell_avx512(const AddCell& cell) {
  prepare(cell);
  int first = 0;
  for (; cell.columns.count - first > 8; first += 16) add_chunk<Fold<SixteenLanes, 1>, 4>(cell, first);
  if (first < cell.columns.count) add_chunk<Fold<SixteenLanes, 2>, 2>(cell, first);
}

__attribute__((target("avx2,fma"))) void add_cell_avx2(const AddCell& cell) {
  prepare(cell);
  for (int first = 0; first < cell.columns.count; first += 8) add_chunk<Fold<EightLanes, 1>, 2>(cell, first);
}

void add_cell_plain(const AddCell& cell) {
  prepare(cell);
  for (int first = 0; first < cell.columns.count; first += 8) add_chunk<Fold<EightLanes, 1>, 1>(cell, first);
}

}  // namespace

void add_cell(const std::array<float, lrp_window_terms>& polynomial, const CellWaves& waves, const WaveTable& table,
              const TileReach& columns, const TilePairs& pairs, CellRoom& room, const TileSums& sums) {
  const AddCell cell{polynomial, waves, table, columns, pairs, room, sums};
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) {
    add_cell_avx512(cell);
  } else if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    add_cell_avx2(cell);
  } else {
    add_cell_plain(cell);
  }
}

}  // namespace textonbench
