// The part of local random-phase noise whose phases are those of the exemplar (Gilet et al., SIGGRAPH Asia 2014,
// section 5): an image of T x T pixels that repeats over the plane, of the bins of most power of one block.
//
// As printed, its cosines are summed in every window of a lattice, which multiplies it by the windows' sum, 1.33 on
// average; divided by that, as here, it is the sum of cosines itself, and all bins together are the block.
//
// Reduction. With fewer cosines than bins, the J strongest are taken; when the mean difference from the structure image
// is above a precision, the image is cut into 2 x 2 blocks, 4 x 4 and so on down to pixels, each with its own J
// cosines. Blocks here overlap by half, and their sums are blended by cos² of the distance from the block's center,
// which add up to 1: so the structure stays continuous, and blocks of one pixel are still exact.
#pragma once

#include <cstdint>
#include <vector>

#include "methods/base/aligned_buffer.h"
#include "methods/base/image.h"
#include "methods/sparse/strata.h"
#include "methods/sparse/wave_points.h"
#include "methods/sparse/wave_sum.h"

namespace textonbench {

/// The bins of most power that hold `ratio` of it, from the strongest on: none for 0, all for 1.
std::vector<Pixel> strongest_bins(const PowerPlane& power, double ratio);

/// The block's Fourier series, restricted to some bins of the half and their mirror images. The block is a square whose
/// side is a power of two.
Image restrict_to_bins(const Image& block, const std::vector<Pixel>& bins);

struct StructureOptions {
  int cosines = 0;              ///< of each block; 0: all bins, one block
  double precision = 1. / 256;  ///< mean |difference| from the structure image at which no more blocks are cut
};

class Structure {
 public:
  /// `bins` of the half, which the image is made of.
  Structure(Image image, const std::vector<Pixel>& bins, const StructureOptions& options);

  /// Of the image's pixels, which is what a lookup repeats after.
  int period() const { return image_.width(); }

  /// What is approximated, zero mean over the exemplar.
  const Image& image() const { return image_; }
  /// Side of the blocks, pixels: that of the image when it is not cut.
  int block_side() const { return side_; }
  /// Cosines of each block.
  int cosines() const { return cosines_; }
  /// Mean |difference| from the image at its pixels.
  double deviation() const { return deviation_; }
  std::size_t bytes() const { return integers_.bytes() + colors_.bytes(); }
  /// Cosines that are evaluated at a point.
  int cosines_at_point() const { return (is_cut() ? 4 : 1) * cosines_; }

  /// The cosines of block (x, y), its phases being zero at its first sample.
  PaddedWaves block(int x, int y) const;
  /// Of the cosines of a block, pixels.
  int block_period() const { return 1 << period_bits_; }

  /// The structure seen through square pixels of a side: cosines by box_response() (wave_filter.h). A block has its own
  /// zero frequency, which no clamping removes: blocks that are smaller than half a footprint give way to larger ones
  /// of one mean each, as of a mip map, unless `mip` is false.
  Structure filtered(double footprint, bool mip = true) const;

  /// Adds weight times the structure at a point, pixel (0, 0) of the image being at the origin.
  void add(const WavePoint& point, float weight, float* out) const;

 private:
  explicit Structure(Image image) : image_(std::move(image)) {}
  bool is_cut() const { return side_ < image_.width(); }
  /// Cuts the image into blocks of a side and takes the strongest cosines of each.
  void cut(int side, int cosines, const std::vector<Pixel>& bins);
  void store(std::size_t block, const Image& samples, const std::vector<Pixel>& bins, int cosines);
  PaddedWaves waves_of(std::size_t block) const;
  double measure_deviation() const;

  Image image_;
  int side_ = 0;
  int period_bits_ = 0;  ///< the cosines of a block have the period 2^period_bits pixels
  int cosines_ = 0;
  int padded_ = 0;
  double deviation_ = 0;
  AlignedBuffer<std::int32_t> integers_;  ///< k_x, k_y and phases of each block
  AlignedBuffer<float> colors_;
};

}  // namespace textonbench
