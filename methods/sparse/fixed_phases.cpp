#include "methods/sparse/fixed_phases.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/base/parallel.h"

namespace textonbench {
namespace {

/// Points that are displaced at a time.
constexpr std::size_t chunk = 4096;

/// Variance of a layer of one channel.
double variance_of(const WaveField& field) {
  const WaveLayer& layer = field.layers.front();
  double sum = 0;
  for (int j = 0; j < layer.waves(); ++j) {
    sum += 0.5 * std::norm(std::complex<double>(layer.color[layer.first[static_cast<std::size_t>(j)]]));
  }
  return sum;
}

/// Adds scale (Σ_S |n_S| − mean) to one coordinate of the points.
void displace_axis(const FixedPhases& fixed, Seed seed, std::span<const WavePoint> points, bool along_y,
                   std::span<WavePoint> displaced) {
  std::vector<float> value(points.size()), sum(points.size());
  for (std::size_t layer = 0; layer < fixed.turbulent.size(); ++layer) {
    sum_waves(fixed.turbulent[layer], turbulence_seed(seed, along_y, layer), points, false, value);
    for (std::size_t i = 0; i < points.size(); ++i) sum[i] += std::abs(value[i]);
  }
  const FixedPhases::Displacement by = fixed.displacement();
  const double scale = by.scale * static_cast<double>(std::int64_t{1} << plane_bits);
  const auto axis = along_y ? &WavePoint::y : &WavePoint::x;
  for (std::size_t i = 0; i < points.size(); ++i) {
    displaced[i].*axis += static_cast<std::int64_t>(std::floor(scale * (static_cast<double>(sum[i]) - by.mean)));
  }
}

/// The block on one axis that a coordinate is in, the neighbor that it is blended with, and the neighbor's part.
struct Blend {
  std::int64_t block;
  std::int64_t neighbor;
  float part;
};

Blend blend(std::int64_t at, std::int64_t side) {
  const std::int64_t block = at / side - (at % side < 0 ? 1 : 0);
  const double margin = static_cast<double>(side) / 12;
  const auto from_left = static_cast<double>(at - block * side);
  const double from_right = static_cast<double>(side) - from_left;
  const double near = std::min(from_left, from_right);
  if (near >= margin) return {block, block, 0};
  // From 1/2 at the border to 0 at the margin, with zero slope there.
  const double t = 0.5 - 0.5 * near / margin;
  return {block, from_left < from_right ? block - 1 : block + 1, static_cast<float>(t * t * (3 - 2 * t))};
}

}  // namespace

int place_at_random(const Stream& stream, int period, const WavePoint& point, PlacedPoint (&places)[4]) {
  constexpr std::int64_t pixel = std::int64_t{1} << plane_bits;
  const std::int64_t side = period * pixel / 2;
  const Blend x = blend(point.x, side), y = blend(point.y, side);
  int count = 0;
  for (int j = 0; j < (y.part > 0 ? 2 : 1); ++j) {
    for (int i = 0; i < (x.part > 0 ? 2 : 1); ++i) {
      const auto words = stream.block(static_cast<std::uint64_t>(j == 0 ? y.block : y.neighbor),
                                      static_cast<std::uint64_t>(i == 0 ? x.block : x.neighbor));
      // Whole pixels, so that a sample on the pixels has the structure's own.
      const auto shift = [&](std::uint32_t word) {
        return static_cast<std::int64_t>((std::uint64_t{word} * static_cast<std::uint64_t>(period)) >> 32U) * pixel;
      };
      places[count++] = {{point.x + shift(words[0]), point.y + shift(words[1])},
                         (i == 0 ? 1 - x.part : x.part) * (j == 0 ? 1 - y.part : y.part)};
    }
  }
  return count;
}

Seed turbulence_seed(Seed seed, bool along_y, std::size_t layer) {
  return derive(derive(seed, along_y ? "lrp turbulence y" : "lrp turbulence x"), layer);
}

Stream placement_stream(Seed seed) { return Stream(seed).child("lrp placement"); }

/// |n| of a normal n of variance v has the mean sqrt(2 v / π) and the variance (1 − 2 / π) v.
FixedPhases::Displacement FixedPhases::displacement() const {
  double mean = 0, variance = 0;
  for (const WaveField& field : turbulent) {
    const double v = variance_of(field);
    mean += std::sqrt(2 * v / std::numbers::pi);
    variance += (1 - 2 / std::numbers::pi) * v;
  }
  return turbulent.empty() ? Displacement{} : Displacement{mean, turbulence / std::sqrt(variance)};
}

void FixedPhases::displace(Seed seed, std::span<const WavePoint> points, std::span<WavePoint> displaced) const {
  std::ranges::copy(points, displaced.begin());
  if (turbulence <= 0) return;
  displace_axis(*this, seed, points, false, displaced);
  displace_axis(*this, seed, points, true, displaced);
}

void FixedPhases::add(Seed seed, std::span<const WavePoint> points, std::span<float> out) const {
  const Stream places_of_seed = placement_stream(seed);
  const int period = structure.period();
  const auto channels = static_cast<std::size_t>(structure.image().channels());
  parallel_for(static_cast<int>((points.size() + chunk - 1) / chunk), [&](int task) {
    const std::size_t first = static_cast<std::size_t>(task) * chunk;
    const auto here = points.subspan(first, std::min(chunk, points.size() - first));
    std::vector<WavePoint> displaced(here.size());
    displace(seed, here, displaced);
    for (std::size_t i = 0; i < here.size(); ++i) {
      float value[Image::max_channels] = {};
      if (placement) {
        PlacedPoint places[4];
        const int count = place_at_random(places_of_seed, period, displaced[i], places);
        for (int k = 0; k < count; ++k) structure.add(places[k].point, places[k].weight, value);
      } else {
        structure.add(displaced[i], 1, value);
      }
      for (std::size_t c = 0; c < channels; ++c) out[c * points.size() + first + i] += value[c];
    }
  });
}

std::size_t FixedPhases::bytes() const {
  std::size_t sum = structure.bytes();
  for (const WaveField& field : turbulent) sum += field.layers.front().bytes();
  return sum;
}

}  // namespace textonbench
