#include "methods/sparse/wave_field.h"

#include <array>

namespace textonbench {
namespace {

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

std::int64_t part_of(std::int64_t length, std::uint32_t word) { return (length * (word >> 8U)) >> 24U; }

}  // namespace

std::size_t WaveLayer::bytes() const {
  return sizeof(std::uint32_t) * (first.size() + chance.size()) + sizeof(std::int32_t) * (kx.size() + ky.size()) +
         sizeof(std::complex<float>) * color.size();
}

WaveCell::WaveCell(const WaveField& field, const WaveLayer& layer)
    : waves(layer.waves()),
      padded((layer.waves() + vector - 1) / vector * vector),
      kx(static_cast<std::size_t>(padded)),
      ky(static_cast<std::size_t>(padded)),
      phase(static_cast<std::size_t>(padded)),
      color(static_cast<std::size_t>(2 * padded * field.channels)) {
  kx.set_zero();
  ky.set_zero();
  phase.set_zero();
  color.set_zero();
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

void WaveLattice::draw(std::int64_t cx, std::int64_t cy, WaveCell& cell) const {
  const auto colors = static_cast<std::uint64_t>(layer_->colors);
  std::array<std::uint32_t, 4> words{};
  for (int j = 0; j < cell.waves; ++j) {
    if (j % 2 == 0) {
      words = philox_block(key_ ^ static_cast<std::uint64_t>(j / 2), static_cast<std::uint64_t>(cy),
                           static_cast<std::uint64_t>(cx));
    }
    const auto wave = static_cast<std::size_t>(j);
    const std::uint64_t first = layer_->first[wave];
    const std::uint64_t place = std::uint64_t{words[2 * (wave % 2)]} * (layer_->first[wave + 1] - first);
    const std::uint64_t bin = first + (place >> 32U);
    std::uint64_t entry = bin * colors;
    const auto rest = static_cast<std::uint32_t>(place);
    for (const std::uint64_t last = entry + colors - 1; entry < last && rest >= layer_->chance[entry];) ++entry;
    cell.kx.data()[wave] = layer_->kx[bin];
    cell.ky.data()[wave] = layer_->ky[bin];
    cell.phase.data()[wave] = words[2 * (wave % 2) + 1];
    const std::complex<float>* color = layer_->color.data() + entry * static_cast<std::uint64_t>(channels_);
    for (int c = 0; c < channels_; ++c) {
      cell.color.data()[2 * c * cell.padded + j] = color[c].real();
      cell.color.data()[(2 * c + 1) * cell.padded + j] = color[c].imag();
    }
  }
}

}  // namespace textonbench
