#include "experiments/metrics/lrp_diagrams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "methods/base/convolution.h"
#include "methods/sparse/lrp.h"
#include "methods/sparse/wave_raster.h"

namespace textonbench {
namespace {

using Color = std::array<float, 3>;

/// Hues a golden angle apart, in three shades.
Color color_of(std::size_t i) {
  const double hue = std::fmod(static_cast<double>(i) * 0.381966, 1.0);
  const double light = 0.95 - 0.15 * static_cast<double>(i % 3);
  Color color{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double wave = std::cos(2 * std::numbers::pi * (hue - static_cast<double>(c) / 3));
    color[c] = static_cast<float>(light * (0.55 + 0.45 * wave));
  }
  return color;
}

/// Of a square spectrum, zero frequency in the middle; black where nothing is drawn.
class SpectrumPicture {
 public:
  SpectrumPicture(int side, int channels) : image_({side, side}, channels) {}

  /// Colors a bin and its mirror image.
  void set(int kx, int ky, const Color& color) {
    const int side = image_.width();
    for (const int sign : {1, -1}) {
      const int x = ((sign * kx + side / 2) % side + side) % side, y = ((sign * ky + side / 2) % side + side) % side;
      for (int c = 0; c < image_.channels(); ++c) {
        const auto channel = static_cast<std::size_t>(c % 3);
        image_.at(c, x, y) = image_.channels() < 3 ? (color[0] + color[1] + color[2]) / 3 : color[channel];
      }
    }
  }
  void set(int kx, int ky, double gray) {
    const auto v = static_cast<float>(gray);
    set(kx, ky, Color{v, v, v});
  }

  Image take() { return std::move(image_); }

 private:
  Image image_;
};

Image power_picture(const LrpAnalysis& lrp) {
  const int side = lrp.spectrum.side();
  SpectrumPicture picture(side, lrp.field.channels);
  double most = 0;
  const PowerPlane plane(side);
  const auto power = [&](const Pixel& bin) { return lrp.spectrum.power(bin.x, (bin.y + side) % side); };
  for (const Pixel& bin : plane.half()) most = std::max(most, power(bin));
  for (const Pixel& bin : plane.half()) {
    picture.set(bin.x, bin.y, std::clamp(1 + std::log10(std::max(power(bin) / most, 1e-30)) / 6, 0.0, 1.0));
  }
  return picture.take();
}

Image sets_picture(const LrpAnalysis& lrp, LrpDiagram diagram) {
  SpectrumPicture picture(lrp.spectrum.side(), lrp.field.channels);
  std::size_t color = 0;
  for (const LrpLayer& layer : lrp.layers) {
    if (diagram == LrpDiagram::strata) {
      for (const Pixel& bin : layer.stratum.bins) picture.set(bin.x, bin.y, color_of(color));
    }
    for (const std::vector<Pixel>& part : layer.stratum.parts) {
      if (diagram != LrpDiagram::strata) {
        for (const Pixel& bin : part) picture.set(bin.x, bin.y, color_of(color));
      }
      color += diagram == LrpDiagram::parts ? 1 : 0;
    }
    color += diagram == LrpDiagram::parts ? 0 : 1;
  }
  return picture.take();
}

/// |ŵ|² of the radial window at a frequency, over that at zero, by quadrature of its Hankel transform.
double window_power(LrpWindow window, double frequency) {
  constexpr int nodes = 96;
  double at = 0, zero = 0;
  for (int i = 1; i < nodes; ++i) {
    const double r = 1.5 * i / nodes;
    const double mass = r * lrp_window(window, r);
    at += mass * std::cyl_bessel_j(0, 2 * std::numbers::pi * frequency * r);
    zero += mass;
  }
  return std::pow(at / zero, 2);
}

Image windows_picture(const LrpAnalysis& lrp) {
  const int side = lrp.spectrum.side();
  SpectrumPicture picture(side, lrp.field.channels);
  std::vector<double> table;
  for (int i = 0; i <= 256; ++i) table.push_back(window_power(lrp.field.window, i / 128.0));
  std::vector<Color> sums(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (std::size_t l = 0; l < lrp.field.layers.size(); ++l) {
    const WaveLattice lattice(lrp.field, l, Seed{1});
    std::vector<Wave> waves(static_cast<std::size_t>(lattice.layer().waves()));
    lattice.draw(0, 0, waves);
    for (const Wave& wave : waves) {
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          const int kx = x - side / 2, ky = y - side / 2;
          const double bins =
              std::min(std::hypot(kx - wave.bin.kx, ky - wave.bin.ky), std::hypot(kx + wave.bin.kx, ky + wave.bin.ky));
          const double frequency = bins * lattice.layer().pixels() / side;
          if (frequency >= 2) continue;
          const auto part = static_cast<float>(table[static_cast<std::size_t>(128 * frequency)]);
          const Color color = color_of(l);
          Color& sum = sums[static_cast<std::size_t>(y * std::ptrdiff_t{side} + x)];
          for (std::size_t c = 0; c < 3; ++c) sum[c] = std::max(sum[c], part * color[c]);
        }
      }
    }
  }
  for (int y = 0; y < side; ++y) {
    for (int x = side / 2; x < side; ++x) {
      picture.set(x - side / 2, y - side / 2, sums[static_cast<std::size_t>(y * std::ptrdiff_t{side} + x)]);
    }
  }
  return picture.take();
}

Image layer_picture(const LrpAnalysis& lrp, std::size_t layer, const Domain& domain) {
  if (layer >= lrp.field.layers.size()) {
    throw std::invalid_argument("a picture asked of a stratum that lrp has not: it has fewer");
  }
  WaveField field = lrp.field;
  field.layers = {lrp.field.layers[layer]};
  Image out(domain.size, field.channels);
  add_waves(field, Seed{1}, {domain.origin.x, domain.origin.y, domain.step}, out);
  add_constant(lrp.spectrum.mean(), out);
  return out;
}

Image variance_picture(const LrpAnalysis& lrp) {
  const int side = lrp.spectrum.side();
  std::vector<double> variance(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  double mean = 0;
  for (std::size_t l = 0; l < lrp.layers.size(); ++l) {
    const double spacing = lrp.field.layers[l].pixels(), energy = lrp.layers[l].stratum.energy;
    for (int i = 0; i < side * side; ++i) {
      const double x = i % side / spacing, y = std::floor(static_cast<double>(i) / side) / spacing;
      double squares = 0;
      for (int k = 0; k < 9; ++k) {
        const int dx = k % 3 - 1, dy = k / 3 - 1;
        squares +=
            std::pow(lrp_window(lrp.field.window, std::hypot(x - std::round(x) - dx, y - std::round(y) - dy)), 2);
      }
      const double here = energy * (lrp.field.even_variance ? 1 : squares);
      variance[static_cast<std::size_t>(i)] += here;
      mean += here / (side * side);
    }
  }
  Image picture({side, side}, lrp.field.channels);
  for (int c = 0; c < picture.channels(); ++c) {
    for (int i = 0; i < side * side; ++i) {
      picture.at(c, i % side, i / side) = static_cast<float>(0.5 * variance[static_cast<std::size_t>(i)] / mean);
    }
  }
  return picture;
}

Image structure_picture(const LrpAnalysis& lrp, LrpDiagram diagram) {
  if (!lrp.fixed) throw std::invalid_argument("a picture asked of the structure of lrp: expected structure above 0");
  const Structure& structure = lrp.fixed->structure;
  Image picture = structure.image();
  if (diagram != LrpDiagram::structure) {
    for (int i = 0; i < picture.width() * picture.height(); ++i) {
      const int x = i % picture.width(), y = i / picture.width();
      float values[Image::max_channels] = {};
      structure.add({std::int64_t{x} << plane_bits, std::int64_t{y} << plane_bits}, 1, values);
      for (int c = 0; c < picture.channels(); ++c) {
        float& v = picture.at(c, x, y);
        v = diagram == LrpDiagram::reduced ? values[c] : 0.5F + 32 * (v - values[c]);
      }
    }
  }
  if (diagram != LrpDiagram::residual) add_constant(lrp.spectrum.mean(), picture);
  return picture;
}

}  // namespace

Image lrp_diagram(const Model& model, LrpDiagram diagram, const Domain& domain) {
  const LrpAnalysis* lrp = lrp_analysis_of(model);
  if (lrp == nullptr) {
    throw std::invalid_argument("a picture of strata and windows asked of a method that has none: expected lrp");
  }
  switch (diagram) {
    case LrpDiagram::power:
      return power_picture(*lrp);
    case LrpDiagram::strata:
    case LrpDiagram::eroded:
    case LrpDiagram::parts:
      return sets_picture(*lrp, diagram);
    case LrpDiagram::windows:
      return windows_picture(*lrp);
    case LrpDiagram::layer_1:
    case LrpDiagram::layer_2:
    case LrpDiagram::layer_3:
    case LrpDiagram::layer_4:
      return layer_picture(*lrp, static_cast<std::size_t>(diagram) - static_cast<std::size_t>(LrpDiagram::layer_1),
                           domain);
    case LrpDiagram::variance:
      return variance_picture(*lrp);
    case LrpDiagram::structure:
    case LrpDiagram::reduced:
    case LrpDiagram::residual:
      return structure_picture(*lrp, diagram);
  }
  throw std::logic_error("unknown diagram");
}

}  // namespace textonbench
