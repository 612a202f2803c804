#include "methods/sparse/wave_table.h"

#include <vector>

#include "methods/sparse/wave_lanes.h"

namespace textonbench {
namespace {

using TableLanes = EightLanes;

__attribute__((target_clones("default", "avx2"))) void fill_bin(std::uint32_t k, std::span<const std::uint32_t> turns,
                                                                float* cosines, float* sines) {
  for (std::size_t i = 0; i < turns.size(); i += TableLanes::count) {
    TableLanes::Floats cosine, sine;
    cos_sin_lanes<TableLanes>(*reinterpret_cast<const TableLanes::LooseWords*>(turns.data() + i) * k, cosine, sine);
    *reinterpret_cast<TableLanes::LooseFloats*>(cosines + i) = cosine;
    *reinterpret_cast<TableLanes::LooseFloats*>(sines + i) = sine;
  }
}

}  // namespace

WaveTable::WaveTable(int least, int most, std::span<const std::uint32_t> turns)
    : least_(least),
      stride_((static_cast<int>(turns.size()) + surplus + 15) / 16 * 16),
      values_(static_cast<std::size_t>(most - least + 1) * 2 * static_cast<std::size_t>(stride_)) {
  std::vector<std::uint32_t> padded(turns.begin(), turns.end());
  padded.resize(static_cast<std::size_t>(stride_));
  float* to = values_.data();
  for (int k = least; k <= most; ++k, to += std::ptrdiff_t{2} * stride_) {
    fill_bin(static_cast<std::uint32_t>(k), padded, to, to + stride_);
  }
}

}  // namespace textonbench
