#include "methods/sparse/wave_tile.h"

#include <cmath>

#include "methods/sparse/wave_lanes.h"

namespace textonbench {

TileSums::TileSums(int channels)
    : channels_(channels),
      values_(static_cast<std::size_t>((wave_tile_side + 1) * (channels + 1) * channel_stride + wave_surplus)) {}

LayerColors::LayerColors(const WaveLayer& layer, int channels)
    : stride_((2 * static_cast<std::size_t>(channels) + 7) / 8 * 8),
      values_(layer.color.size() / static_cast<std::size_t>(channels) * stride_) {
  values_.set_zero();
  for (std::size_t i = 0; i < layer.color.size(); ++i) {
    const std::size_t entry = i / static_cast<std::size_t>(channels), channel = i % static_cast<std::size_t>(channels);
    float* to = values_.data() + entry * stride_ + 2 * channel;
    to[0] = layer.color[i].real();
    to[1] = layer.color[i].imag();
  }
}

CellRoom::CellRoom(std::size_t waves, const LayerColors& layer, int channels)
    : cosines(waves + wave_surplus),
      sines(waves + wave_surplus),
      colors(waves * layer.stride()),
      columns(waves),
      rows(waves),
      products(2 * static_cast<std::size_t>(channels) * waves * SixteenLanes::count) {}

__attribute__((target_clones("default", "avx2", "avx512f"))) void invert_roots(const float* squares, int count,
                                                                               float* scale) {
  for (int x = 0; x < count; ++x) scale[x] = 1 / std::sqrt(squares[x]);
}

}  // namespace textonbench
