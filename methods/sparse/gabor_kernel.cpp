#include "methods/sparse/gabor_kernel.h"

#include <cmath>
#include <numbers>

#include "methods/sparse/wave_lanes.h"
#include "methods/sparse/wave_points.h"

namespace textonbench {
namespace {

using PlaceLanes = SixteenLanes;

/// 2^e for −100 < e <= 0, within 2e-7 of it.
[[gnu::always_inline]] inline void exp2_lanes(const PlaceLanes::Floats& e, PlaceLanes::Floats& power) {
  const PlaceLanes::Ints whole = __builtin_convertvector(e - 0.5F, PlaceLanes::Ints);
  const PlaceLanes::Floats f = e - __builtin_convertvector(whole, PlaceLanes::Floats);
  const PlaceLanes::Floats series =
      1.0F +
      f * (6.93147182e-1F +
           f * (2.40226462e-1F + f * (5.55033647e-2F + f * (9.61837219e-3F + f * (1.33952829e-3F + f * 1.54035e-4F)))));
  const PlaceLanes::Ints scale = (whole + 127) << 23;
  power = series * reinterpret_cast<const PlaceLanes::Floats&>(scale);
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void turns_of(std::int32_t frequency, std::uint32_t phase,
                                                                           const std::int32_t* distance, int count,
                                                                           std::uint32_t* turns) {
  for (int i = 0; i < count; ++i) {
    const std::int64_t product = std::int64_t{frequency} * distance[i];  // 2^−50 turn
    turns[i] = static_cast<std::uint32_t>(static_cast<std::uint64_t>(product) >> 18U) + phase;
  }
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void waves_of(const std::uint32_t* turns, int count,
                                                                           float* cosine, float* sine) {
  for (int i = 0; i < count; i += PlaceLanes::count) {
    PlaceLanes::Floats c, s;
    const PlaceLanes::Words words = *reinterpret_cast<const PlaceLanes::LooseWords*>(turns + i);
    cos_sin_lanes<PlaceLanes>(words, c, s);
    *reinterpret_cast<PlaceLanes::LooseFloats*>(cosine + i) = c;
    *reinterpret_cast<PlaceLanes::LooseFloats*>(sine + i) = s;
  }
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void windows_of(float coefficient,
                                                                             const std::int32_t* distance, int count,
                                                                             const float* cosine, const float* sine,
                                                                             float* form, float* real,
                                                                             float* imaginary) {
  using LooseInts = std::int32_t __attribute__((vector_size(64), aligned(4), may_alias));
  constexpr float to_log2 = -4.53236014F;  // −π / ln 2
  for (int i = 0; i < count; i += PlaceLanes::count) {
    const PlaceLanes::Ints whole = *reinterpret_cast<const LooseInts*>(distance + i);
    const PlaceLanes::Floats t = __builtin_convertvector(whole, PlaceLanes::Floats) * 0x1p-20F;
    const PlaceLanes::Floats square = coefficient * (t * t);
    // Far beyond the window, where it is cut, powers are those of the last place that is in range.
    const PlaceLanes::Floats within = square < 20.0F ? square : PlaceLanes::Floats{} + 20.0F;
    PlaceLanes::Floats window;
    exp2_lanes(to_log2 * within, window);
    *reinterpret_cast<PlaceLanes::LooseFloats*>(form + i) = square;
    *reinterpret_cast<PlaceLanes::LooseFloats*>(real + i) =
        window * *reinterpret_cast<const PlaceLanes::LooseFloats*>(cosine + i);
    *reinterpret_cast<PlaceLanes::LooseFloats*>(imaginary + i) =
        window * *reinterpret_cast<const PlaceLanes::LooseFloats*>(sine + i);
  }
}

std::int64_t rounded_up(double pixels) { return static_cast<std::int64_t>(std::ceil(pixels * plane_pixel)) + 1; }

std::int32_t turns_a_pixel(double frequency) { return static_cast<std::int32_t>(std::lround(frequency * 0x1p30)); }

}  // namespace

GaborShape::GaborShape(const GaborBand& band)
    : along(static_cast<float>(band.window.xx)),
      across(static_cast<float>(band.window.determinant() / band.window.xx)),
      limit(static_cast<float>(band.window.limit())),
      shear(band.window.xy / band.window.xx),
      reach_x(rounded_up(band.window.half_width())),
      reach_y(rounded_up(band.window.half_height())) {
  frequency.reserve(2 * band.frequency.size());
  for (const GaborFrequency& f : band.frequency) {
    frequency.push_back(turns_a_pixel(f.x));
    frequency.push_back(turns_a_pixel(f.y));
  }
}

void KernelPlaces::resize(int count) {
  count_ = count;
  const auto room = static_cast<std::size_t>((count + block - 1) / block) * block;
  if (room <= distance_.size()) return;
  distance_.resize(room), turns_.resize(room);
  for (std::vector<float>* numbers : {&cosine_, &sine_, &real_, &imaginary_, &form_}) numbers->resize(room);
}

void KernelPlaces::set_waves(std::int32_t frequency, std::uint32_t phase) {
  turns_of(frequency, phase, distance_.data(), count_, turns_.data());
  waves_of(turns_.data(), count_, cosine_.data(), sine_.data());
}

void KernelPlaces::set_windows(float coefficient, const std::int32_t* distance, int first, int end) {
  const int from = first / block * block;
  windows_of(coefficient, distance + from, end - from, cosine_.data() + from, sine_.data() + from, form_.data() + from,
             real_.data() + from, imaginary_.data() + from);
}

}  // namespace textonbench
