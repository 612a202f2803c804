// Random impacts of the plane, drawn cell by cell, that CPU and GPU share bit for bit: integer hashes and fixed-point
// positions only.
//
// Square cells of side a cover the plane; cell (cx, cy) holds the points of [cx a, (cx + 1) a) x [cy a, (cy + 1) a).
// Its random words w_0, w_1, … are those of the blocks
//
//   (w_4j, …, w_4j+3) = Philox4x32-10(key ^ j, counter = (cx, cy)),
//
// the coordinates as 64-bit integers and their low words first, so cells repeat after 2^64 of them along each axis:
// beyond any coordinate that is allowed. Impact i of a cell is made of the words u = w_{2i+2} and v = w_{2i+3}: its
// position is (u >> 8, v >> 8) 2^−24 cell sides, its kernel (((u & 255) << 8 | v & 255) K) >> 16.
//   poisson         as many impacts as there are thresholds at most w_0 (poisson_thresholds)
//   signed_poisson  the same, of weight −1 where v is odd
//   stratified      one impact, of weight −1 if the highest bit of w_0 is set
// With K no power of two, a kernel's probability is off 1/K by at most 2^−16.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "methods/base/random.h"

namespace textonbench {

/// poisson: an exact Poisson number of impacts a cell, of weight 1. signed_poisson: of weight ±1 instead, so that sums
/// have mean zero whatever the kernels. stratified: one impact a cell, of weight ±1 with equal probability. paper: the
/// shader of Texton Noise (CGF 2017) with its defects, for the claims about it: a cell's generator is a xorshift (13,
/// 17, 5) started at Wang's hash of 1024 (cy mod 1024) + (cx mod 1024) + key, so the noise has a period of 1024 cells
/// and the cells of key + 1 are those of key moved by one; and the number of impacts is a rounded Gaussian number
/// (paper_count), set to 0 where it is negative.
enum class ImpactProcess { poisson, signed_poisson, stratified, paper };

/// Greatest mean number of impacts a cell.
constexpr double max_cell_mean = 600;

/// t_n = floor(2^32 P(N <= n)) of the Poisson law, up to the last one below 2^32: a uniform 32-bit word is at least t_n
/// with probability P(N > n), to 2^−32. Made from additions, multiplications and divisions alone: the same numbers on
/// every machine. Throws std::invalid_argument for a mean outside [0, max_cell_mean].
std::vector<std::uint32_t> poisson_thresholds(double mean);

/// floor(mean + 1/2 + sqrt(mean) g), g the normal number that Box and Muller make of the uniform words u > 0 and v:
/// what the paper takes for a Poisson number. Its variance is 1/12 too large, and it may be negative.
std::int64_t paper_count(double mean, std::uint32_t u, std::uint32_t v);

struct CellImpact {
  std::uint32_t x = 0;  ///< in 2^−24 cell sides, below 2^24
  std::uint32_t y = 0;
  std::int32_t kernel = 0;
  float weight = 1;
};

/// Bits after the binary point of plane coordinates in pixels: |x| < 2^40 and a margin fit 64-bit integers.
constexpr int plane_bits = 22;

/// `weight` times kernel number `kernel` at a point of the plane, in 2^−22 pixel.
struct PlaneImpact {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int32_t kernel = 0;
  float weight = 1;
};

/// The points [left, right) x [top, bottom), in 2^−22 pixel.
struct PlaneRectangle {
  std::int64_t left = 0;
  std::int64_t top = 0;
  std::int64_t right = 0;
  std::int64_t bottom = 0;
};

class ImpactGrid {
 public:
  /// `intensity` impacts a pixel in [1e-12, 64], each of one of `kernels` kernels. `side` of the cells in pixels, where
  /// the process leaves a choice; stratified cells have the area of an impact. Sides are rounded to 1/1024 pixel, so
  /// that the cells far from the origin are exact. Throws std::invalid_argument for an intensity or a mean number of
  /// impacts a cell out of range.
  ImpactGrid(ImpactProcess process, double intensity, double side, int kernels);

  ImpactProcess process() const { return process_; }
  /// Side of a cell, pixels.
  double side() const { return static_cast<double>(side_) / side_unit; }
  /// The same in 1/1024 pixel.
  std::int64_t coarse_side() const { return side_; }
  /// poisson_thresholds() of the mean of a cell; none in the processes that need none.
  const std::vector<std::uint32_t>& thresholds() const { return thresholds_; }
  /// Impacts a pixel: as asked for, or 1 / side² of stratified cells after rounding.
  double intensity() const { return intensity_; }
  /// Expected sum of weights a pixel.
  double mean_weight() const {
    return process_ == ImpactProcess::poisson || process_ == ImpactProcess::paper ? intensity_ : 0;
  }
  /// Mean number of impacts a cell.
  double cell_mean() const { return intensity_ * side() * side(); }

  /// From then on draw() gives an impact the kernel that this function tells for its place, in 2^−22 pixel.
  void choose_kernels(std::function<std::int32_t(std::int64_t x, std::int64_t y)> kernel_at) {
    kernel_at_ = std::move(kernel_at);
  }

  /// Impacts of one cell, in their order, after those that are there.
  void draw_cell(std::uint64_t key, std::int64_t cx, std::int64_t cy, std::vector<CellImpact>& impacts) const;

  /// Impacts in a rectangle, whose corners are at most 2^41 pixels from the origin: cell after cell, a row of cells
  /// after the other, after those that are there. So two rectangles have their common impacts in one order. Positions
  /// are rounded down to 2^−22 pixel.
  void draw(std::uint64_t key, const PlaneRectangle& rectangle, std::vector<PlaneImpact>& impacts) const;

  /// Rectangle of each row of cells that meets `rectangle`, cut to it.
  std::vector<PlaneRectangle> cell_rows(const PlaneRectangle& rectangle) const;

 private:
  static constexpr int side_bits = 10;
  static constexpr double side_unit = 1 << side_bits;
  /// 2^−22 pixel in a cell's side.
  std::int64_t plane_side() const { return side_ << (plane_bits - side_bits); }

  template <class Visit>
  void visit_cell(std::uint64_t key, std::int64_t cx, std::int64_t cy, const Visit& visit) const;
  template <class Visit>
  void visit_paper_cell(std::uint64_t key, std::int64_t cx, std::int64_t cy, const Visit& visit) const;

  ImpactProcess process_;
  double intensity_;
  std::int64_t side_;  // in 1/1024 pixel
  std::uint32_t kernels_;
  std::vector<std::uint32_t> thresholds_;  // of poisson and signed_poisson
  std::function<std::int32_t(std::int64_t, std::int64_t)> kernel_at_;
};

}  // namespace textonbench
