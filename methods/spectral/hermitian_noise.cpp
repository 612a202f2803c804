#include "methods/spectral/hermitian_noise.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace textonbench {
namespace {

using Column = std::vector<std::complex<float>>;

/// Noise of column kx: bin ky is number ky of row kx of the stream.
void draw(const Stream& stream, HermitianNoise noise, int kx, Column& column) {
  const auto row = static_cast<std::uint64_t>(kx);
  if (noise == HermitianNoise::phase) {
    fill_phasor(stream, row, 0, column);
  } else {
    fill_normal(stream, row, 0, {reinterpret_cast<float*>(column.data()), 2 * column.size()});
  }
}

/// Makes a self-conjugate bin real with the variance (or the modulus) of the other bins.
std::complex<float> real_bin(HermitianNoise noise, std::complex<float> bin) {
  if (noise == HermitianNoise::phase) {
    return bin.real() < 0 ? -1.0F : 1.0F;
  }
  return std::numbers::sqrt2_v<float> * bin.real();
}

/// Lets the lower half of a column whose mirror image is stored too repeat its upper half conjugated.
void make_hermitian(HermitianNoise noise, Column& column) {
  const std::size_t rows = column.size();
  for (std::size_t ky = 0; ky <= rows / 2; ++ky) {
    const std::size_t mirror = (rows - ky) % rows;
    if (mirror == ky) {
      column[ky] = real_bin(noise, column[ky]);
    } else {
      column[mirror] = std::conj(column[ky]);
    }
  }
}

/// spot *= scale * noise.
__attribute__((target_clones("default", "avx2", "avx512f"))) void multiply(const float* noise, float scale,
                                                                           std::size_t bins, float* spot) {
  for (std::size_t i = 0; i < bins; ++i) {
    const float re = scale * noise[2 * i];
    const float im = scale * noise[2 * i + 1];
    const float spot_re = spot[2 * i];
    const float spot_im = spot[2 * i + 1];
    spot[2 * i] = spot_re * re - spot_im * im;
    spot[2 * i + 1] = spot_re * im + spot_im * re;
  }
}

}  // namespace

Image modulate(const GaussianModel& model, const Stream& stream, HermitianNoise noise) {
  const Spectrum& spot = model.spectrum.factors.front();
  const Extent raster = spot.raster();
  // N is scaled so that the un-normalised inverse transform gives the sample: sqrt(|Ω|) / |Ω|, and for the Gaussian
  // noise 1 / sqrt(2) for the real and the imaginary part each.
  const double per_part = noise == HermitianNoise::gaussian ? std::numbers::sqrt2 / 2 : 1.0;
  const auto scale = static_cast<float>(per_part / std::sqrt(static_cast<double>(raster.area())));
  const auto source = [&](int first, const ColumnBlock& block) {
    thread_local Column column;
    column.resize(static_cast<std::size_t>(raster.height));
    for (int c = 0; c < spot.channels(); ++c) {
      copy_columns(spot, c, first, block);
    }
    for (int i = 0; i < ColumnBlock::width && first + i < spot.columns(); ++i) {
      draw(stream, noise, first + i, column);
      if (spot.multiplicity(first + i) == 1) {
        make_hermitian(noise, column);
      }
      for (int c = 0; c < spot.channels(); ++c) {
        multiply(reinterpret_cast<const float*>(column.data()), scale, column.size(),
                 reinterpret_cast<float*>(block.column(c, i)));
      }
    }
    for (int c = 0; c < spot.channels() && first == 0; ++c) {
      block.column(c, 0)[0] = static_cast<float>(model.mean[static_cast<std::size_t>(c)]);
    }
  };
  return unnormalized_inverse_fft(raster, spot.channels(), source);
}

}  // namespace textonbench
