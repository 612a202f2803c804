#include "methods/sparse/gabor_kernel.h"

#include <cmath>
#include <numbers>

namespace textonbench {
namespace {

std::int64_t rounded_up(double pixels) { return static_cast<std::int64_t>(std::ceil(pixels * plane_pixel)) + 1; }

}  // namespace

GaborShape::GaborShape(const GaborField& field, const GaborBand& band)
    : channels(field.channels),
      half_width(band.window.half_width()),
      half_height(band.window.half_height()),
      reach_x(rounded_up(half_width)),
      reach_y(rounded_up(half_height)),
      cell(field.process == ImpactProcess::stratified ? 1 / std::sqrt(band.intensity) : band.cell),
      colors(band.color.data()) {
  const GaborWindow& window = band.window;
  const double to_log2 = std::numbers::pi / std::numbers::ln2;
  along = static_cast<float>(std::sqrt(to_log2 * window.xx));
  shear = static_cast<float>(std::sqrt(to_log2 * window.xx) * window.xy / window.xx);
  across = static_cast<float>(std::sqrt(to_log2 * window.determinant() / window.xx));
  limit = static_cast<float>(-std::log2(window.cut));
  cut = static_cast<float>(window.cut);
  turns.reserve(band.frequency.size());
  for (const GaborFrequency& f : band.frequency) {
    turns.push_back({static_cast<std::uint32_t>(std::llround(f.x * 0x1p32)),
                     static_cast<std::uint32_t>(std::llround(f.y * 0x1p32)), static_cast<float>(f.x * 0x1p29),
                     static_cast<float>(f.y * 0x1p29)});
  }
}

}  // namespace textonbench
