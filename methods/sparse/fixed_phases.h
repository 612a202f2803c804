// Structure in local random-phase noise without repetition and period (Gilet et al., SIGGRAPH Asia 2014, section 5.2).
//
// Turbulence: the structure is looked up at x + σ n_T(x), where n_T sums the absolute values of a few layers of noise
// with the exemplar's spectrum. The paper's n_T is one number; here x and y have one each, of mean 0 and variance 1, so
// that σ is the displacement's standard deviation along an axis in pixels.
//
// Random placement: half-period blocks of the plane look the structure up at a place of their own, drawn uniformly, and
// are blended over a twelfth of their side on each side of a border. The order matters: blocks are those of the
// displaced point. If each block displaced its own coordinates instead, the displacement would jump from block to
// block.
#pragma once

#include <span>
#include <vector>

#include "methods/sparse/structure.h"
#include "methods/sparse/wave_field.h"

namespace textonbench {

/// What of a spectrum keeps the exemplar's phases, and how it is looked up.
struct FixedPhaseOptions {
  double ratio = 0;       ///< r, part of the power: the strongest bins that hold it
  bool reduced = true;    ///< to r J cosines in blocks; false: all bins
  double turbulence = 0;  ///< σ, pixels
  bool placement = false;
};

struct FixedPhases {
  Structure structure;
  double turbulence = 0;             ///< σ, pixels
  std::vector<WaveField> turbulent;  ///< the layers of n_T, of one channel
  bool placement = false;

  /// Where the structure is looked up for each point, before random placement.
  void displace(Seed seed, std::span<const WavePoint> points, std::span<WavePoint> displaced) const;
  /// out[c * points.size() + i] += n_R at points[i].
  void add(Seed seed, std::span<const WavePoint> points, std::span<float> out) const;
  /// Mean of Σ |n_S|, and the pixels that a unit of it displaces. None without turbulence.
  struct Displacement {
    double mean = 0;
    double scale = 0;
  };
  Displacement displacement() const;
  std::size_t bytes() const;
};

/// Where the numbers of turbulence along x and y and of random placement come from.
Seed turbulence_seed(Seed seed, bool along_y, std::size_t layer);
Stream placement_stream(Seed seed);

/// A place where random placement looks the structure up.
struct PlacedPoint {
  WavePoint point;
  float weight = 0;
};

/// The one to four of a point; their weights add up to 1. `period` is that of the structure, pixels.
int place_at_random(const Stream& stream, int period, const WavePoint& point, PlacedPoint (&places)[4]);

}  // namespace textonbench
