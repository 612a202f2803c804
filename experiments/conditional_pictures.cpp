#include "experiments/conditional_pictures.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "experiments/inpainting_pictures.h"

namespace textonbench {
namespace {

const Conditional& conditional(const PictureSource& source) {
  const Conditional* law = source.model.conditional();
  if (law == nullptr) {
    throw std::invalid_argument("a picture of missing pixels asked of a method that has none: expected inpainting");
  }
  return *law;
}

const Image& first_sample(const PictureSource& source) {
  if (source.samples.empty())
    throw std::invalid_argument("a picture of a sample asked of a run without: raise samples");
  return source.samples.front();
}

/// What the first sample adds to the kriging component.
Image innovation(const PictureSource& source) {
  const Conditional& law = conditional(source);
  const Image& sample = first_sample(source);
  std::vector<double> mean;
  const auto known = static_cast<double>(sample.extent().area() - law.missing().count());
  for (int c = 0; c < sample.channels(); ++c) {
    double sum = 0;
    for (int y = 0; y < sample.height(); ++y) {
      for (int x = 0; x < sample.width(); ++x)
        sum += law.missing().at(x, y) ? 0.0 : static_cast<double>(sample.at(c, x, y));
    }
    mean.push_back(sum / known);
  }
  return innovation_picture(sample, law.kriging(), law.missing(), mean);
}

/// As much again on every side of the missing pixels, where the picture has it.
Image hole(const PictureSource& source) {
  const Image& sample = first_sample(source);
  const std::vector<Pixel> pixels = pixels_of(conditional(source).missing());
  const Rectangle box = bounding_box(pixels);
  const int left = std::max(0, box.x - box.size.width / 2), top = std::max(0, box.y - box.size.height / 2);
  const int right = std::min(sample.width(), box.x + box.size.width + box.size.width / 2);
  const int bottom = std::min(sample.height(), box.y + box.size.height + box.size.height / 2);
  return crop(sample, left, top, {right - left, bottom - top});
}

constexpr std::array conditional_entries{
    PictureEntry{
        "masked", "Masked input",
        [](const PictureSource& s) { return without_pixels(s.target.exemplar.pixels, conditional(s).missing()); }},
    PictureEntry{
        "conditioning", "Conditioning points",
        [](const PictureSource& s) { return only_pixels(s.target.exemplar.pixels, conditional(s).conditioning()); }},
    PictureEntry{"kriging", "Kriging component", [](const PictureSource& s) { return conditional(s).kriging(); }},
    PictureEntry{"innovation", "Innovation component", innovation},
    PictureEntry{"unconditional", "Sample given nothing",
                 [](const PictureSource& s) { return conditional(s).unconditional(Seed{1}); }},
    PictureEntry{"hole", "Close-up of the missing part", hole},
};

}  // namespace

std::span<const PictureEntry> conditional_pictures() { return conditional_entries; }

}  // namespace textonbench
