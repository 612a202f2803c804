#include "methods/sparse/wave_field.h"

#include <algorithm>
#include <array>

namespace textonbench {
namespace {

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

std::int64_t part_of(std::int64_t length, std::uint32_t word) { return (length * (word >> 8U)) >> 24U; }

}  // namespace

std::size_t WaveLayer::bytes() const {
  return sizeof(std::uint32_t) * (first.size() + chance.size()) + sizeof(WaveBin) * bins.size() +
         sizeof(std::complex<float>) * color.size();
}

WaveLattice::WaveLattice(const WaveField& field, std::size_t layer, Seed seed)
    : layer_(&field.layers[layer]), channels_(field.channels) {
  const Stream stream = Stream(seed).child("lrp").child(layer);
  key_ = stream.key();
  const auto words = stream.child("corner").block(0, 0);
  corner_x_ = part_of(layer_->spacing, words[0]);
  corner_y_ = part_of(layer_->spacing, words[1]);
}

std::int64_t WaveLattice::nearest_x(std::int64_t x) const {
  return floor_divide(x - corner_x_ + layer_->spacing / 2, layer_->spacing);
}

std::int64_t WaveLattice::nearest_y(std::int64_t y) const {
  return floor_divide(y - corner_y_ + layer_->spacing / 2, layer_->spacing);
}

void WaveLattice::draw(std::int64_t cx, std::int64_t cy, std::span<Wave> waves) const {
  const auto count = static_cast<std::size_t>(layer_->waves());
  const std::size_t blocks = (count + 1) / 2;
  const std::size_t cells = waves.size() / count;
  // So many blocks at a time; `cell` and `block` are those of the first one.
  constexpr std::size_t chunk = 64;
  std::uint64_t keys[chunk], indices[chunk];
  std::array<std::uint32_t, 4> words[chunk];
  std::size_t cell = 0, block = 0;
  for (std::size_t left = cells * blocks; left > 0;) {
    const std::size_t here = std::min(chunk, left);
    std::size_t next_cell = cell, next_block = block;
    for (std::size_t i = 0; i < here; ++i) {
      keys[i] = key_ ^ next_block;
      indices[i] = static_cast<std::uint64_t>(cx) + next_cell;
      if (++next_block == blocks) next_block = 0, ++next_cell;
    }
    philox_blocks({keys, here}, static_cast<std::uint64_t>(cy), {indices, here}, {words, here});
    for (std::size_t i = 0; i < here; ++i) {
      const std::size_t j = 2 * block;
      Wave* wave = &waves[cell * count + j];
      wave[0] = make_wave(j, words[i][0], words[i][1]);
      if (j + 1 < count) wave[1] = make_wave(j + 1, words[i][2], words[i][3]);
      if (++block == blocks) block = 0, ++cell;
    }
    left -= here;
  }
}

Wave WaveLattice::make_wave(std::size_t j, std::uint32_t u, std::uint32_t v) const {
  const std::uint32_t first = layer_->first[j];
  const std::uint64_t place = std::uint64_t{u} * (layer_->first[j + 1] - first);
  const std::size_t bin = first + static_cast<std::size_t>(place >> 32U);
  const auto rest = static_cast<std::uint32_t>(place);
  const auto colors = static_cast<std::size_t>(layer_->colors);
  std::size_t entry = bin * colors;
  for (std::size_t c = 1; c < colors; ++c) entry += rest >= layer_->chance[bin * colors + c - 1] ? 1 : 0;
  return {layer_->bins[bin], v, layer_->color.data() + entry * static_cast<std::size_t>(channels_)};
}

}  // namespace textonbench
