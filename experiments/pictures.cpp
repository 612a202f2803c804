#include "experiments/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "experiments/conditional_pictures.h"
#include "experiments/lrp_pictures.h"
#include "methods/base/parallel.h"
#include "methods/base/spectrum.h"

namespace textonbench {
namespace {

template <std::size_t index>
Image sample(const PictureSource& source) {
  if (index >= source.samples.size()) {
    throw std::invalid_argument(fmt::format("picture of sample {} asked of a run with samples = {}: raise samples",
                                            index + 1, source.samples.size()));
  }
  return source.samples[index];
}

/// A sixth of the first sample a side, in the middle across, around the height `down` of its own.
Image close_up(const PictureSource& source, double down) {
  const Image whole = sample<0>(source);
  const Extent part{std::max(1, whole.width() / 6), std::max(1, whole.height() / 6)};
  const auto top = static_cast<int>(std::lround(down * whole.height())) - part.height / 2;
  return crop(whole, (whole.width() - part.width) / 2, std::clamp(top, 0, whole.height() - part.height), part);
}

/// u − per(u) + 1/2: the smooth component has mean zero.
Image smooth_component(const PictureSource& source) {
  Image difference = source.target.exemplar.pixels;
  const Image& periodic = source.target.periodic_component;
  for (int c = 0; c < difference.channels(); ++c) {
    parallel_for(difference.height(), [&](int y) {
      const std::span<float> out = difference.row(c, y);
      const std::span<const float> p = periodic.row(c, y);
      for (std::size_t x = 0; x < out.size(); ++x) out[x] = out[x] - p[x] + 0.5F;
    });
  }
  return difference;
}

/// The kernels, or their coefficients, in a square: zero is mid-gray, and four standard deviations of a kernel's values
/// lie on either side.
Image texton_picture(const PictureSource& source) {
  const SplineTexton* spline = source.model.spline_texton();
  const Texton* texton = spline != nullptr ? &spline->coefficients : source.model.texton();
  if (texton == nullptr) throw std::invalid_argument("picture of the texton asked of a method that has none");
  const int count = static_cast<int>(texton->kernels.size());
  const int columns = static_cast<int>(std::ceil(std::sqrt(count))), rows = (count + columns - 1) / columns;
  constexpr int gap = 2;
  const Extent each = texton->extent();
  Image picture({columns * (each.width + gap) - gap, rows * (each.height + gap) - gap}, texton->channels());
  for (int c = 0; c < picture.channels(); ++c) {
    for (int y = 0; y < picture.height(); ++y) std::ranges::fill(picture.row(c, y), 1.0F);
  }
  double energy = 0;
  for (const Image& kernel : texton->kernels) {
    for (int c = 0; c < kernel.channels(); ++c) {
      for (int y = 0; y < kernel.height(); ++y) {
        for (const float v : kernel.row(c, y)) energy += double{v} * v;
      }
    }
  }
  const double numbers = static_cast<double>(texton->support_pixels) * count * texton->channels();
  const auto scale = static_cast<float>(energy > 0 ? 0.125 / std::sqrt(energy / numbers) : 0);
  for (int k = 0; k < count; ++k) {
    const Image& kernel = texton->kernels[static_cast<std::size_t>(k)];
    const int left = k % columns * (each.width + gap), top = k / columns * (each.height + gap);
    for (int c = 0; c < kernel.channels(); ++c) {
      for (int y = 0; y < kernel.height(); ++y) {
        std::ranges::transform(kernel.row(c, y), picture.row(c, top + y).begin() + left,
                               [&](float v) { return 0.5F + scale * v; });
      }
    }
  }
  return picture;
}

constexpr std::array general_entries{
    PictureEntry{"sample", "Sample", sample<0>},
    PictureEntry{"sample_2", "Second sample", sample<1>},
    PictureEntry{"sample_3", "Third sample", sample<2>},
    PictureEntry{"exemplar", "Exemplar", [](const PictureSource& s) { return Image(s.target.exemplar.pixels); }},
    PictureEntry{"periodic_component", "Periodic component",
                 [](const PictureSource& s) { return Image(s.target.periodic_component); }},
    PictureEntry{"smooth_component", "Smooth component + 1/2", smooth_component},
    PictureEntry{"exemplar_modulus", "Modulus of the exemplar",
                 [](const PictureSource& s) { return modulus_picture(s.target.exemplar.pixels); }},
    PictureEntry{"periodic_modulus", "Modulus of the periodic component",
                 [](const PictureSource& s) { return modulus_picture(s.target.periodic_component); }},
    PictureEntry{"exemplar_phase", "Phase of the exemplar",
                 [](const PictureSource& s) { return phase_picture(s.target.exemplar.pixels); }},
    PictureEntry{"sample_modulus", "Modulus of the sample",
                 [](const PictureSource& s) { return modulus_picture(sample<0>(s)); }},
    PictureEntry{"mean_modulus", "Modulus of the samples",
                 [](const PictureSource& s) { return mean_modulus_picture(s.samples); }},
    PictureEntry{"texton", "Texton", texton_picture},
    PictureEntry{"sample_far", "Close-up of the upper part", [](const PictureSource& s) { return close_up(s, 0.2); }},
    PictureEntry{"sample_near", "Close-up of the lower part", [](const PictureSource& s) { return close_up(s, 0.8); }},
    PictureEntry{"sample_phase", "Phase of the sample",
                 [](const PictureSource& s) { return phase_picture(sample<0>(s)); }},
};

}  // namespace

std::span<const PictureEntry> picture_catalog() {
  static const std::vector<PictureEntry> all = [] {
    std::vector<PictureEntry> entries(general_entries.begin(), general_entries.end());
    for (const std::span<const PictureEntry> more : {conditional_pictures(), lrp_pictures()}) {
      entries.insert(entries.end(), more.begin(), more.end());
    }
    return entries;
  }();
  return all;
}

const PictureEntry& find_picture(std::string_view name) {
  std::vector<std::string_view> names;
  names.reserve(picture_catalog().size());
  for (const PictureEntry& entry : picture_catalog()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw std::invalid_argument(fmt::format("unknown picture \"{}\"{}", name, did_you_mean(name, names)));
}

}  // namespace textonbench
