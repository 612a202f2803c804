// Local random-phase noise as it is written, in double precision and by libm: the oracle of the fast versions.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "methods/sparse/wave_field.h"
#include "methods/sparse/wave_points.h"

namespace textonbench {

/// Per channel: value, ∂/∂x, ∂/∂y a pixel.
inline std::vector<std::array<double, 3>> plain_waves(const WaveField& field, Seed seed, const WavePoint& point) {
  constexpr double unit = std::int64_t{1} << plane_bits;
  const double turn = 2 * std::numbers::pi;
  const double side = std::pow(2, field.side_bits);
  const auto channels = static_cast<std::size_t>(field.channels);
  const auto value = [&](double shift_x, double shift_y) {
    std::vector<double> all(channels);
    for (std::size_t l = 0; l < field.layers.size(); ++l) {
      const WaveLattice lattice(field, l, seed);
      std::vector<double> sum(channels);
      double squares = 0;
      for (std::int64_t dy = -2; dy <= 2; ++dy) {
        for (std::int64_t dx = -2; dx <= 2; ++dx) {
          const std::int64_t cx = lattice.nearest_x(point.x) + dx, cy = lattice.nearest_y(point.y) + dy;
          const double x = static_cast<double>(point.x - lattice.center_x(cx)) / unit + shift_x;
          const double y = static_cast<double>(point.y - lattice.center_y(cy)) / unit + shift_y;
          const double w = lrp_window(field.window, std::hypot(x, y) / field.layers[l].pixels());
          squares += w * w;
          std::vector<Wave> waves(static_cast<std::size_t>(field.layers[l].waves()));
          lattice.draw(cx, cy, waves);
          for (const Wave& wave : waves) {
            const double angle = turn * ((wave.bin.kx * x + wave.bin.ky * y) / side + wave.phase * 0x1p-32);
            for (std::size_t c = 0; c < channels; ++c) {
              sum[c] += w * (static_cast<double>(wave.color[c].real()) * std::cos(angle) -
                             static_cast<double>(wave.color[c].imag()) * std::sin(angle));
            }
          }
        }
      }
      for (std::size_t c = 0; c < channels; ++c) all[c] += field.even_variance ? sum[c] / std::sqrt(squares) : sum[c];
    }
    return all;
  };
  const double h = 1e-4;
  const auto here = value(0, 0), left = value(-h, 0), right = value(h, 0), above = value(0, -h), below = value(0, h);
  std::vector<std::array<double, 3>> result;
  for (std::size_t c = 0; c < channels; ++c) {
    result.push_back({here[c], (right[c] - left[c]) / (2 * h), (below[c] - above[c]) / (2 * h)});
  }
  return result;
}

}  // namespace textonbench
