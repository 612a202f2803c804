// The inner loop of sum_by_impact: a row of tiles, each of whose sums stay in registers while its impacts pass by.
#pragma once

#include <cstddef>
#include <span>

#include "methods/base/bspline.h"

namespace textonbench {

/// Floats of a cache line, the width of a tile.
constexpr int tile_width = 16;

/// Rows of a tile, so many that their sums fill the 32 registers of AVX-512.
constexpr int tile_height(int order) { return order == 0 ? 16 : 24 / (order + 1); }

/// Weights of an impact's taps along either axis, with the sum 1: the last one is never looked at.
struct TapWeights {
  float x[max_bspline_order + 1] = {};
  float y[max_bspline_order + 1] = {};
};

/// An impact that reaches a tile: `from` is the tap under the tile's first pixel, in a kernel whose frame of zeros
/// holds the rest of the tile.
struct TileVisit {
  const float* from;
  const TapWeights* weights;
};

/// Visits of the tiles of a row, from left to right: tile i has [first[i], first[i + 1]).
struct TileRow {
  std::span<const TileVisit> visits;
  std::span<const std::size_t> first;
  std::ptrdiff_t stride;  ///< of the kernels
};

/// Rows of an image, in whole lines from the first tile on. A line needs the tile to its right too, if order > 0.
struct TileRowOutput {
  float* data;
  std::ptrdiff_t stride;  ///< floats, a multiple of tile_width: tiles beyond have no line
  int rows;               ///< at most tile_height(order)
};

/// out(x, y) = start + Σ_visits Σ_j wy_j Σ_i wx_i from(x + i, y + j), `from` being moved by `offset` floats. A visit
/// adds in fused multiply-adds, one after the other: the bits depend neither on the tile nor on the processor. One that
/// has no such instruction takes about a hundred times longer.
void sum_tiles(int order, const TileRow& tiles, std::ptrdiff_t offset, float start, const TileRowOutput& out);

}  // namespace textonbench
