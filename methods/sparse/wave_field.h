// Local random-phase noise as a sum of layers (Gilet et al., SIGGRAPH Asia 2014, equations 1 and 2):
//
//   n(x) = Σ_layers s(x) Σ_i w(|x − x_i| / Δ) Σ_j Re( a_ij exp(2πi (k_ij · (x − x_i) / T + u_ij)) ),
//
// x_i = o + Δ i the nine lattice points around x, a_ij complex colors, k_ij bins of a torus of T x T pixels and u_ij
// uniform phases. o, the corner of the lattice, is uniform too, so that the noise is stationary as a random field; the
// paper has o = 0. s = 1 as in the paper, or 1 / sqrt(Σ_i w²) for a variance that does not follow the lattice.
//
// Positions are integers in 2^−22 pixel and phases integers in 2^−32 turn: T is a power of two, so processors of any
// kind add up the same phases, bit for bit, at any distance from the origin.
//
// Random numbers. Layer l of a seed has the stream Stream(seed).child("lrp").child(l), of key K. Its corner is
// ((w_0 >> 8) Δ, (w_1 >> 8) Δ) 2^−24, w the block (0, 0) of child("corner"). Waves 2j and 2j + 1 of cell (cx, cy) take
// the words 0, 1 and 2, 3 of the Philox block with the key K ^ j and the counter (cx, cy), as in impact_grid.h: of the
// words (u, v) of a wave, t = u n picks bin t >> 32 of its part's n bins and, by the lower half of t, one of the bin's
// colors; v is the phase.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/base/impact_grid.h"
#include "methods/base/random.h"
#include "methods/sparse/lrp_window.h"

namespace textonbench {

struct WaveBin {
  std::int32_t kx = 0;
  std::int32_t ky = 0;
};

/// The bins that wave j of a cell is drawn of: [first[j], first[j + 1]). Bin b has `colors` colors: color v is taken
/// with probability (chance[b * colors + v] − chance[b * colors + v − 1]) 2^−32, the last one otherwise, and its
/// channels are color[(b * colors + v) * channels + c], amplitude included.
struct WaveLayer {
  std::int64_t spacing = 0;  ///< Δ in 2^−22 pixel
  std::vector<std::uint32_t> first;
  std::vector<WaveBin> bins;
  int colors = 1;
  std::vector<std::uint32_t> chance;
  std::vector<std::complex<float>> color;

  int waves() const { return static_cast<int>(first.size()) - 1; }
  double pixels() const { return static_cast<double>(spacing) / (std::int64_t{1} << plane_bits); }
  std::size_t bytes() const;
};

/// What all layers share.
struct WaveField {
  int channels = 1;
  int side_bits = 7;  ///< T = 2^side_bits pixels
  LrpWindow window = LrpWindow::bessel;
  bool even_variance = true;  ///< s = 1 / sqrt(Σ_i w²)
  std::vector<WaveLayer> layers;

  /// Turns in 2^−32 of one bin over a distance in 2^−22 pixel.
  std::uint32_t turns(std::int64_t distance) const {
    constexpr int even = 32 - plane_bits;
    return static_cast<std::uint32_t>(side_bits <= even ? distance << (even - side_bits)
                                                        : distance >> (side_bits - even));
  }
};

/// A wave of a cell.
struct Wave {
  WaveBin bin;
  std::uint32_t phase = 0;                     ///< at the cell's center, 2^−32 turn
  const std::complex<float>* color = nullptr;  ///< of all channels
};

/// Waves of cells that follow each other in a row: wave j of cell number i is at i * padded + j.
struct DrawnWaves {
  std::size_t padded = 0;  ///< places of a cell, a multiple of 8; those that are no waves have zeros
  std::vector<std::int32_t> kx, ky;
  std::vector<std::uint32_t> phase;                 ///< as of a Wave
  std::vector<std::uint32_t> color;                 ///< number of the color among all those of the layer
  std::vector<std::array<std::uint32_t, 4>> words;  ///< what they were drawn from
};

/// A layer's lattice and numbers for one seed.
class WaveLattice {
 public:
  WaveLattice(const WaveField& field, std::size_t layer, Seed seed);

  const WaveLayer& layer() const { return *layer_; }
  std::uint64_t key() const { return key_; }
  /// Number of the lattice point nearest to a coordinate, and the coordinate of one, in 2^−22 pixel.
  std::int64_t nearest_x(std::int64_t x) const;
  std::int64_t nearest_y(std::int64_t y) const;
  std::int64_t center_x(std::int64_t cx) const { return corner_x_ + cx * layer_->spacing; }
  std::int64_t center_y(std::int64_t cy) const { return corner_y_ + cy * layer_->spacing; }
  /// Waves of the cells (cx, cy), (cx + 1, cy), …, layer().waves() of each, as many as fill `waves`.
  void draw(std::int64_t cx, std::int64_t cy, std::span<Wave> waves) const;
  /// The same of `cells` cells. Faster where `drawn` is used again; only by one lattice, as its places without waves
  /// keep their zeros.
  void draw(std::int64_t cx, std::int64_t cy, std::size_t cells, DrawnWaves& drawn) const;

 private:
  const WaveLayer* layer_;
  int channels_;
  std::uint64_t key_;
  std::int64_t corner_x_ = 0, corner_y_ = 0;
};

}  // namespace textonbench
