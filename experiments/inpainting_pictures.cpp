#include "experiments/inpainting_pictures.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "methods/base/image_io.h"

namespace textonbench {
namespace {

constexpr int caption_font = 14;
constexpr int caption_height = 24;
constexpr int strip_gap = 8;
constexpr float frame_value = 0.6F;
constexpr int least_side = 160;
constexpr int most_side = 512;

Extent shown_extent(Extent extent) {
  const int longer = std::max(extent.width, extent.height);
  if (longer > most_side) {
    const auto reduced = [&](int side) {
      return std::max(1, static_cast<int>(std::int64_t{side} * most_side / longer));
    };
    return {reduced(extent.width), reduced(extent.height)};
  }
  const int factor = (least_side + longer - 1) / longer;
  return {factor * extent.width, factor * extent.height};
}

}  // namespace

Image only_pixels(const Image& picture, const Mask& shown) {
  double sum = 0;
  double number = 0;
  for (int c = 0; c < picture.channels(); ++c) {
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        if (!shown.at(x, y)) continue;
        sum += static_cast<double>(picture.at(c, x, y));
        ++number;
      }
    }
  }
  const float background = sum > number / 2 ? 0.0F : 1.0F;
  Image result(picture.extent(), picture.channels());
  for (int c = 0; c < picture.channels(); ++c) {
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        result.at(c, x, y) = shown.at(x, y) ? picture.at(c, x, y) : background;
      }
    }
  }
  return result;
}

Image without_pixels(const Image& picture, const Mask& hidden) {
  return only_pixels(picture, difference(Mask(hidden.extent(), true), hidden));
}

Image innovation_picture(const Image& sample, const Image& kriging, const Mask& missing, std::span<const double> mean) {
  Image result(sample.extent(), sample.channels());
  for (int c = 0; c < sample.channels(); ++c) {
    const auto center = static_cast<float>(mean[static_cast<std::size_t>(c)]);
    for (int y = 0; y < sample.height(); ++y) {
      for (int x = 0; x < sample.width(); ++x) {
        result.at(c, x, y) = missing.at(x, y) ? center + (sample.at(c, x, y) - kriging.at(c, x, y)) : center;
      }
    }
  }
  return result;
}

Image picture_strip(std::span<const CaptionedPicture> pictures) {
  if (pictures.empty()) throw std::invalid_argument("a strip of no pictures: expected at least one");
  const Image& first = pictures.front().picture;
  const Extent shown = shown_extent(first.extent());
  int cell = shown.width;
  for (const CaptionedPicture& entry : pictures) {
    const Image& picture = entry.picture;
    const bool alike = picture.extent() == first.extent() && picture.channels() == first.channels();
    if (!alike || (picture.channels() != 1 && picture.channels() != 3)) {
      throw std::invalid_argument("pictures of a strip: expected one size, and all gray or all color");
    }
    cell = std::max(cell, text_extent(entry.caption, caption_font).width);
  }
  const auto number = static_cast<int>(pictures.size());
  Image strip({number * (cell + strip_gap) + strip_gap, caption_height + shown.height + strip_gap}, first.channels());
  for (int c = 0; c < strip.channels(); ++c) {
    for (int y = 0; y < strip.height(); ++y) std::ranges::fill(strip.row(c, y), 1.0F);
  }
  int left = strip_gap;
  for (const CaptionedPicture& entry : pictures) {
    const Image picture = resize(entry.picture, shown);
    const int inset = left + (cell - shown.width) / 2;
    for (int c = 0; c < strip.channels(); ++c) {
      // A frame, because a panel may be as white as the paper.
      for (int y = -1; y <= shown.height; ++y) {
        const auto row = strip.row(c, caption_height + y).subspan(static_cast<std::size_t>(inset - 1));
        std::ranges::fill(row.first(static_cast<std::size_t>(shown.width) + 2), frame_value);
      }
      for (int y = 0; y < shown.height; ++y) {
        std::ranges::copy(picture.row(c, y), strip.row(c, caption_height + y).begin() + inset);
      }
    }
    const int text_left = left + (cell - text_extent(entry.caption, caption_font).width) / 2;
    draw_text(strip, text_left, (caption_height + caption_font * 7 / 10) / 2, entry.caption, caption_font);
    left += cell + strip_gap;
  }
  return strip;
}

}  // namespace textonbench
