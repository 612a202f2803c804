#include "experiments/pictures.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <vector>

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

constexpr std::array entries{
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
    PictureEntry{"sample_phase", "Phase of the sample",
                 [](const PictureSource& s) { return phase_picture(sample<0>(s)); }},
};

}  // namespace

std::span<const PictureEntry> picture_catalog() { return entries; }

const PictureEntry& find_picture(std::string_view name) {
  std::vector<std::string_view> names;
  for (const PictureEntry& entry : entries) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw std::invalid_argument(fmt::format("unknown picture \"{}\"{}", name, did_you_mean(name, names)));
}

}  // namespace textonbench
