#include "methods/sparse/wave_filter.h"

#include <cmath>
#include <numbers>

namespace textonbench {
namespace {

double sinc_lobe(double x) {
  if (x == 0) return 1;
  return std::abs(x) < 1 ? std::sin(std::numbers::pi * x) / (std::numbers::pi * x) : 0;
}

}  // namespace

double box_response(int kx, int ky, double side, double footprint) {
  return sinc_lobe(kx * footprint / side) * sinc_lobe(ky * footprint / side);
}

void clamp_frequencies(double footprint, WaveField& field) {
  const double side = std::ldexp(1.0, field.side_bits);
  for (WaveLayer& layer : field.layers) {
    const std::size_t numbers = static_cast<std::size_t>(layer.colors) * static_cast<std::size_t>(field.channels);
    for (std::size_t bin = 0; bin < layer.bins.size(); ++bin) {
      const auto part = static_cast<float>(box_response(layer.bins[bin].kx, layer.bins[bin].ky, side, footprint));
      for (std::size_t i = 0; i < numbers; ++i) layer.color[bin * numbers + i] *= part;
    }
  }
}

}  // namespace textonbench
