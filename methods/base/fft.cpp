#include "methods/base/fft.h"

#include <fmt/format.h>

#include <stdexcept>

#include "methods/base/box_fft.h"
#include "methods/base/fft_lines.h"
#include "methods/base/fft_plan.h"

namespace textonbench {

Spectrum Spectrum::uninitialized(Extent raster, int channels) {
  if (raster.width < 1 || raster.height < 1) {
    throw std::invalid_argument(
        fmt::format("spectrum of a raster of {}x{}: both sides must be at least 1", raster.width, raster.height));
  }
  if (raster.area() > Image::max_pixels) {
    throw std::invalid_argument(
        fmt::format("spectrum of a raster of {}x{}: at most 2^40 pixels are possible", raster.width, raster.height));
  }
  if (channels < 1 || channels > Image::max_channels) {
    throw std::invalid_argument(
        fmt::format("spectrum of {} channels: expected 1 to {}", channels, Image::max_channels));
  }
  Spectrum spectrum;
  spectrum.raster_ = raster;
  spectrum.channels_ = channels;
  spectrum.data_ =
      AlignedBuffer<std::complex<float>>(static_cast<std::size_t>(spectrum.row_stride() * raster.height * channels));
  return spectrum;
}

Spectrum::Spectrum(Extent raster, int channels) : Spectrum(uninitialized(raster, channels)) { data_.set_zero(); }

ColumnBlock::ColumnBlock(Extent raster, int channels)
    : stride_((raster.height + 7) / 8 * 8 + 8),  // not a power of two, which would fill few sets of the cache
      data_(static_cast<std::size_t>(stride_ * ColumnBlock::width * channels)) {
  data_.set_zero();
}

void copy_columns(const Spectrum& spectrum, int channel, int first, const ColumnBlock& block) {
  transpose(spectrum.row(channel, 0).data() + first, spectrum.row_stride(), spectrum.rows(), ColumnBlock::width,
            block.column(channel, 0), block.stride());
}

Spectrum forward_fft(const Image& image) { return forward_fft_of_box(image, image.extent()); }

Image unnormalized_inverse_fft(Extent raster, int channels, const ColumnSource& source) {
  // Columns are transformed in small blocks and stored in the memory of the image, each row of which holds half a
  // spectrum until it is transformed itself. Image rows have room for whole blocks.
  Image image = Image::uninitialized(raster, channels);
  const LineFft transform_column(raster.height, FftDirection::backward);
  parallel_for(block_count(raster), [&](int i) {
    const ColumnBlock& block = scratch_block(raster, channels);
    source(i * ColumnBlock::width, block);
    for (int c = 0; c < channels; ++c) {
      for (int k = 0; k < ColumnBlock::width; ++k) {
        transform_column(block.column(c, k));
      }
      transpose(block.column(c, 0), block.stride(), ColumnBlock::width, raster.height,
                reinterpret_cast<std::complex<float>*>(image.plane(c)) + std::ptrdiff_t{i} * ColumnBlock::width,
                image.row_stride() / 2);
    }
  });
  const LineFft transform_row(raster.width, FftDirection::backward);
  for_row_pairs(raster, channels, [&](int c, int y) {
    float* a = image.row(c, y).data();
    float* b = y + 1 < raster.height ? image.row(c, y + 1).data() : nullptr;
    std::complex<float>* z = scratch_row(raster.width);
    join_spectra(reinterpret_cast<const std::complex<float>*>(a), reinterpret_cast<const std::complex<float>*>(b),
                 raster.width, z);
    transform_row(z);
    split_rows(z, raster.width, a, b);
  });
  return image;
}

Image inverse_fft(const Spectrum& spectrum) {
  Image image =
      unnormalized_inverse_fft(spectrum.raster(), spectrum.channels(), [&](int first, const ColumnBlock& block) {
        for (int c = 0; c < spectrum.channels(); ++c) {
          copy_columns(spectrum, c, first, block);
        }
      });
  const auto scale = static_cast<float>(1.0 / static_cast<double>(spectrum.raster().area()));
  parallel_for(image.channels() * image.height(), [&](int i) {
    for (float& v : image.row(i / image.height(), i % image.height())) {
      v *= scale;
    }
  });
  return image;
}

int good_fft_size(int minimum) {
  constexpr int most = 1 << 30;
  if (minimum < 1 || minimum > most) {
    throw std::invalid_argument(fmt::format("size of at least {}: expected a number in [1, {}]", minimum, most));
  }
  for (int n = minimum;; ++n) {
    int rest = n;
    for (const int factor : {2, 3, 5, 7}) {
      while (rest % factor == 0) {
        rest /= factor;
      }
    }
    if (rest == 1) {
      return n;
    }
  }
}

}  // namespace textonbench
