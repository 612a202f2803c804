// Gabor kernels at many places at a time, for gabor_sum.cpp.
//
// A kernel is a product of its parts along x and y: with s = xy / xx and t = dx + s dy its window is
// exp(−π xx t²) exp(−π h dy²), h = det / xx, and its wave exp(2πi f_x dx) exp(2πi (f_y dy + u)). Numbers of a place do
// not depend on its neighbors in a call: all routes give the same bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "methods/sparse/gabor_field.h"

namespace textonbench {

/// A band's window and frequencies, as the places need them.
struct GaborShape {
  explicit GaborShape(const GaborBand& band);

  float along = 0;                        ///< xx
  float across = 0;                       ///< h
  float limit = 0;                        ///< of the form
  double shear = 0;                       ///< s
  std::int64_t reach_x = 0, reach_y = 0;  ///< of the box around the window, 2^−22 pixel, rounded up
  std::vector<std::int32_t> frequency;    ///< x and y of each entry, 2^−30 turn a pixel
};

/// Numbers of many places, in blocks of sixteen.
class KernelPlaces {
 public:
  static constexpr int block = 16;

  /// Makes room for so many.
  void resize(int count);
  int count() const { return count_; }
  /// Their distances from a kernel's middle, 2^−20 pixel.
  std::int32_t* distance() { return distance_.data(); }
  const float* real() const { return real_.data(); }
  const float* imaginary() const { return imaginary_.data(); }
  const float* form() const { return form_.data(); }

  /// Waves of a frequency and phase at the distances.
  void set_waves(std::int32_t frequency, std::uint32_t phase);
  /// Forms c t² at distances t, and the waves times exp(−π c t²), of the places [first, end) alone.
  void set_windows(float coefficient, const std::int32_t* distance, int first, int end);

 private:
  int count_ = 0;
  std::vector<std::int32_t> distance_;
  std::vector<std::uint32_t> turns_;
  std::vector<float> cosine_, sine_, real_, imaginary_, form_;
};

/// A coordinate in 2^−22 pixel as what places are made of, in 2^−20: distances below 2^11 pixels fit 32 bits.
inline std::int64_t place_coordinate(std::int64_t at) { return at >> 2; }
inline std::int32_t place_distance(std::int64_t to, std::int64_t from) {
  return static_cast<std::int32_t>(place_coordinate(to) - place_coordinate(from));
}

/// s dy of a distance dy, where it is below 2^10 pixels.
inline std::int32_t sheared(double shear, std::int32_t distance) {
  return static_cast<std::int32_t>(std::floor(std::min(std::max(shear * distance, -0x1p30), 0x1p30) + 0.5));
}

}  // namespace textonbench
