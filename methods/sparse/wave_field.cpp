#include "methods/sparse/wave_field.h"

#include <algorithm>
#include <array>

namespace textonbench {
namespace {

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

/// floor(length (word >> 8) / 2^24), without overflow for lengths up to 2^62.
std::int64_t part_of(std::int64_t length, std::uint32_t word) {
  const std::int64_t part = word >> 8U;
  return (length >> 24U) * part + (((length & 0xFFFFFF) * part) >> 24U);
}

/// The waves of a cell by its words, two of each.
__attribute__((target_clones("default", "avx2", "avx512f"))) void make_waves(
    const WaveLayer& layer, const std::uint32_t* __restrict words, std::int32_t* __restrict kx,
    std::int32_t* __restrict ky, std::uint32_t* __restrict phase, std::uint32_t* __restrict color) {
  const auto colors = static_cast<std::uint32_t>(layer.colors);
  const std::uint32_t* first = layer.first.data();
  const WaveBin* bins = layer.bins.data();
  const std::uint32_t* chance = layer.chance.data();
  const int count = layer.waves();
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    const std::uint64_t place = std::uint64_t{words[2 * j]} * (first[j + 1] - first[j]);
    const std::uint32_t bin = first[j] + static_cast<std::uint32_t>(place >> 32U);
    const auto rest = static_cast<std::uint32_t>(place);
    std::uint32_t entry = bin * colors;
    for (std::uint32_t c = 1; c < colors; ++c) entry += rest >= chance[bin * colors + c - 1] ? 1 : 0;
    kx[j] = bins[bin].kx;
    ky[j] = bins[bin].ky;
    phase[j] = words[2 * j + 1];
    color[j] = entry;
  }
}

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

void WaveLattice::draw(std::int64_t cx, std::int64_t cy, std::size_t cells, DrawnWaves& drawn) const {
  const auto count = static_cast<std::size_t>(layer_->waves());
  const std::size_t blocks = (count + 1) / 2;
  drawn.words.resize(cells * blocks);
  std::size_t cell = 0, block = 0;
  for (std::size_t done = 0; done < drawn.words.size();) {
    constexpr std::size_t at_once = 64;
    std::uint64_t keys[at_once], indices[at_once];
    const std::size_t here = std::min(at_once, drawn.words.size() - done);
    for (std::size_t i = 0; i < here; ++i) {
      keys[i] = key_ ^ block;
      indices[i] = static_cast<std::uint64_t>(cx) + cell;
      if (++block == blocks) block = 0, ++cell;
    }
    philox_blocks({keys, here}, static_cast<std::uint64_t>(cy), {indices, here},
                  std::span(drawn.words).subspan(done, here));
    done += here;
  }
  const std::size_t padded = (count + 7) / 8 * 8;
  const std::size_t places = cells * padded;
  if (drawn.padded != padded || drawn.kx.size() < places) {
    drawn.padded = padded;
    drawn.kx.assign(places, 0);
    drawn.ky.assign(places, 0);
    drawn.phase.assign(places, 0);
    drawn.color.assign(places, 0);
  }
  for (std::size_t i = 0; i < cells; ++i) {
    make_waves(*layer_, drawn.words[i * blocks].data(), drawn.kx.data() + i * padded, drawn.ky.data() + i * padded,
               drawn.phase.data() + i * padded, drawn.color.data() + i * padded);
  }
}

void WaveLattice::draw(std::int64_t cx, std::int64_t cy, std::span<Wave> waves) const {
  const auto count = static_cast<std::size_t>(layer_->waves());
  DrawnWaves drawn;
  draw(cx, cy, waves.size() / count, drawn);
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const std::size_t from = i / count * drawn.padded + i % count;
    waves[i] = {{drawn.kx[from], drawn.ky[from]},
                drawn.phase[from],
                layer_->color.data() + std::size_t{drawn.color[from]} * static_cast<std::size_t>(channels_)};
  }
}

}  // namespace textonbench
