#include "experiments/conditional_pictures.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

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
  const Image kriging = law.kriging();
  Image result = first_sample(source);
  for (int c = 0; c < result.channels(); ++c) {
    double sum = 0;
    std::int64_t known = 0;
    for (int y = 0; y < result.height(); ++y) {
      for (int x = 0; x < result.width(); ++x) {
        if (law.missing().at(x, y)) continue;
        sum += static_cast<double>(result.at(c, x, y));
        ++known;
      }
    }
    const auto mean = static_cast<float>(sum / static_cast<double>(known));
    for (int y = 0; y < result.height(); ++y) {
      for (int x = 0; x < result.width(); ++x) result.at(c, x, y) += mean - kriging.at(c, x, y);
    }
  }
  return result;
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
    PictureEntry{"masked", "Masked input",
                 [](const PictureSource& s) { return marked(s.target.exemplar.pixels, conditional(s).missing()); }},
    PictureEntry{"conditioning", "Conditioning points",
                 [](const PictureSource& s) { return only(s.target.exemplar.pixels, conditional(s).conditioning()); }},
    PictureEntry{"kriging", "Kriging component", [](const PictureSource& s) { return conditional(s).kriging(); }},
    PictureEntry{"innovation", "Innovation component", innovation},
    PictureEntry{"unconditional", "Sample given nothing",
                 [](const PictureSource& s) { return conditional(s).unconditional(Seed{1}); }},
    PictureEntry{"hole", "Close-up of the missing part", hole},
};

}  // namespace

std::span<const PictureEntry> conditional_pictures() { return conditional_entries; }

Image marked(const Image& picture, const Mask& missing) {
  constexpr std::array magenta{1.0F, 0.0F, 1.0F};
  Image result = picture;
  for (const Pixel& p : pixels_of(missing)) {
    for (int c = 0; c < result.channels(); ++c) {
      result.at(c, p.x, p.y) = result.channels() == 3 ? magenta[static_cast<std::size_t>(c)] : 1.0F;
    }
  }
  return result;
}

Image only(const Image& picture, const Mask& shown) {
  Image result(picture.extent(), picture.channels());
  for (int c = 0; c < result.channels(); ++c) {
    for (int y = 0; y < result.height(); ++y) {
      for (int x = 0; x < result.width(); ++x) result.at(c, x, y) = shown.at(x, y) ? picture.at(c, x, y) : 0.5F;
    }
  }
  return result;
}

}  // namespace textonbench
