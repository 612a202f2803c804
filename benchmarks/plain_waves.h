// Local random-phase noise as its definition is usually programmed, in floats and with the library's cosines: what the
// fast versions are compared with.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "methods/base/image.h"
#include "methods/sparse/lrp_window.h"
#include "methods/sparse/wave_field.h"
#include "methods/sparse/wave_points.h"

namespace textonbench {

/// The noise of one seed on a rectangle of the plane, whose cells are all drawn in advance.
class PlainWaves {
 public:
  /// The points [left, right] x [top, bottom], in pixels. `field` must outlive this.
  PlainWaves(const WaveField& field, Seed seed, double left, double top, double right, double bottom) : field_(field) {
    for (std::size_t l = 0; l < field.layers.size(); ++l) {
      const WaveLattice lattice(field, l, seed);
      // A point's nine lattice points are next to its nearest one.
      const std::int64_t first_x = lattice.nearest_x(fixed(left)) - 1, last_x = lattice.nearest_x(fixed(right)) + 1;
      const std::int64_t first_y = lattice.nearest_y(fixed(top)) - 1, last_y = lattice.nearest_y(fixed(bottom)) + 1;
      const auto across = static_cast<std::size_t>(last_x - first_x + 1);
      const auto down = static_cast<std::size_t>(last_y - first_y + 1);
      const auto waves = static_cast<std::size_t>(lattice.layer().waves());
      Layer& layer = layers_.emplace_back(Layer{lattice, first_x, first_y, across, {}});
      layer.cells.resize(across * down * waves);
      for (std::size_t row = 0; row < down; ++row) {
        lattice.draw(first_x, first_y + static_cast<std::int64_t>(row),
                     std::span(layer.cells).subspan(row * across * waves, across * waves));
      }
    }
  }

  /// out[c] = n_c(point), without the mean.
  void at(const WavePoint& point, std::span<float> out) const {
    constexpr float pixel = 1.0F / (std::int64_t{1} << plane_bits);
    constexpr auto turn = static_cast<float>(2 * std::numbers::pi);
    const auto& polynomial = lrp_window_polynomial(field_.window);
    const float bin = turn / static_cast<float>(1 << field_.side_bits);
    const auto channels = static_cast<std::size_t>(field_.channels);
    for (float& value : out) value = 0;
    for (const Layer& layer : layers_) {
      const auto waves = static_cast<std::size_t>(layer.lattice.layer().waves());
      const auto spacing = static_cast<float>(layer.lattice.layer().pixels());
      const std::int64_t near_x = layer.lattice.nearest_x(point.x), near_y = layer.lattice.nearest_y(point.y);
      std::array<float, Image::max_channels> sum{};
      float squares = 0;
      for (std::int64_t cy = near_y - 1; cy <= near_y + 1; ++cy) {
        for (std::int64_t cx = near_x - 1; cx <= near_x + 1; ++cx) {
          const float x = static_cast<float>(point.x - layer.lattice.center_x(cx)) * pixel;
          const float y = static_cast<float>(point.y - layer.lattice.center_y(cy)) * pixel;
          const float t = 1 - (x * x + y * y) / (2.25F * spacing * spacing);
          if (t <= 0) continue;
          float p = 0;
          for (std::size_t m = polynomial.size(); m-- > 0;) p = p * t + polynomial[m];
          const float w = t * std::sqrt(t) * p;
          squares += w * w;
          const std::size_t cell = static_cast<std::size_t>(cy - layer.first_y) * layer.across +
                                   static_cast<std::size_t>(cx - layer.first_x);
          for (const Wave& wave : std::span(layer.cells).subspan(cell * waves, waves)) {
            const float angle = bin * (static_cast<float>(wave.bin.kx) * x + static_cast<float>(wave.bin.ky) * y) +
                                turn * 0x1p-32F * static_cast<float>(wave.phase);
            const float cosine = w * std::cos(angle), sine = w * std::sin(angle);
            for (std::size_t c = 0; c < channels; ++c) {
              sum[c] += wave.color[c].real() * cosine - wave.color[c].imag() * sine;
            }
          }
        }
      }
      const float scale = field_.even_variance ? 1 / std::sqrt(squares) : 1;
      for (std::size_t c = 0; c < channels; ++c) out[c] += scale * sum[c];
    }
  }

 private:
  struct Layer {
    WaveLattice lattice;
    std::int64_t first_x, first_y;  ///< of the cells
    std::size_t across;             ///< cells of a row
    std::vector<Wave> cells;        ///< waves of each, row after row
  };

  static std::int64_t fixed(double pixels) {
    return static_cast<std::int64_t>(std::floor(pixels * static_cast<double>(std::int64_t{1} << plane_bits)));
  }

  const WaveField& field_;
  std::vector<Layer> layers_;
};

}  // namespace textonbench
