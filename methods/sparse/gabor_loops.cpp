// The inner loops of Gabor noise, compiled for processors with registers of 64 bytes, of 32, and for others; the last
// have no fused multiply-adds, which then are functions, and take about a hundred times longer.
#include <algorithm>
#include <cmath>

#include "methods/base/image.h"
#include "methods/sparse/gabor_point_sum.h"
#include "methods/sparse/gabor_tile.h"
#include "methods/sparse/wave_lanes.h"

// Vectors are returned by functions that are always inlined, where no calling convention matters.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace textonbench {
namespace {

/// Impacts at points: the arguments of add_impacts.
struct AddImpacts {
  const GaborShape& shape;
  const GaborPoints& points;
  std::span<const NearImpact> impacts;
  const ImpactChoice& chosen;
  float* sums;
};

/// Pixels that bounds of kernels are widened by, for what their numbers are rounded.
constexpr float bound_margin = 0.01F;

/// The arguments of add_to_tile.
struct AddToTile {
  const GaborShape& shape;
  std::span<const NearImpact> impacts;
  const GaborTileAxis& x;
  const GaborTileAxis& y;
  GaborTileRoom& room;
  const GaborTileSums& sums;
};

/// The first index along an axis of pixels from `low` to `high`, and the end, with two more on both sides.
std::int32_t index_before(const GaborTileAxis& axis, float low) {
  return static_cast<std::int32_t>(
      std::clamp(std::floor((double{low} - axis.start) / axis.step) - 2, 0.0, static_cast<double>(axis.count)));
}
std::int32_t index_after(const GaborTileAxis& axis, float high) {
  return static_cast<std::int32_t>(
      std::clamp(std::ceil((double{high} - axis.start) / axis.step) + 3, 0.0, static_cast<double>(axis.count)));
}

// Vectors are taken apart in functions whose processor has no such registers, before they are inlined into others: all
// of the loops are compiled for theirs.
#ifndef __clang__
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq")
#endif
namespace gabor_avx512 {
using Lanes = SixteenLanes;
[[maybe_unused]] constexpr bool has_fused = true;
#include "methods/sparse/gabor_lanes.h"
#include "methods/sparse/gabor_point_loops.h"
#include "methods/sparse/gabor_tile_loops.h"
}  // namespace gabor_avx512
#ifndef __clang__
#pragma GCC pop_options
#endif

#ifndef __clang__
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#endif
namespace gabor_avx2 {
using Lanes = EightLanes;
[[maybe_unused]] constexpr bool has_fused = true;
#include "methods/sparse/gabor_lanes.h"
#include "methods/sparse/gabor_point_loops.h"
#include "methods/sparse/gabor_tile_loops.h"
}  // namespace gabor_avx2
#ifndef __clang__
#pragma GCC pop_options
#endif

namespace gabor_plain {
using Lanes = EightLanes;
[[maybe_unused]] constexpr bool has_fused = false;
#include "methods/sparse/gabor_lanes.h"
#include "methods/sparse/gabor_point_loops.h"
#include "methods/sparse/gabor_tile_loops.h"
}  // namespace gabor_plain

enum class Registers { avx512, avx2, plain };

Registers registers_at_hand() {
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) return Registers::avx512;
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? Registers::avx2 : Registers::plain;
}

}  // namespace

void add_impacts(const GaborShape& shape, const GaborPoints& points, std::span<const NearImpact> impacts,
                 const ImpactChoice& chosen, float* sums) {
  const AddImpacts add{shape, points, impacts, chosen, sums};
  switch (registers_at_hand()) {
    case Registers::avx512:
      return gabor_avx512::add_channels_at_points(add);
    case Registers::avx2:
      return gabor_avx2::add_channels_at_points(add);
    case Registers::plain:
      return gabor_plain::add_channels_at_points(add);
  }
}

void add_to_tile(const GaborShape& shape, std::span<const NearImpact> impacts, const GaborTileAxis& x,
                 const GaborTileAxis& y, GaborTileRoom& room, const GaborTileSums& sums) {
  const AddToTile add{shape, impacts, x, y, room, sums};
  switch (registers_at_hand()) {
    case Registers::avx512:
      return gabor_avx512::add_kernels(add);
    case Registers::avx2:
      return gabor_avx2::add_kernels(add);
    case Registers::plain:
      return gabor_plain::add_kernels(add);
  }
}

}  // namespace textonbench
