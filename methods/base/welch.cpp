#include "methods/base/welch.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "methods/base/parallel.h"
#include "methods/base/spectrum.h"

namespace textonbench {
namespace {

/// Starts of blocks along an axis: the first at 0, the last at the end, the others evenly between.
std::vector<int> starts(int size, int side, double overlap) {
  const int room = size - side;
  const auto steps = static_cast<int>(std::ceil(room / (side * (1 - overlap))));
  std::vector<int> all;
  all.reserve(static_cast<std::size_t>(steps) + 1);
  for (int i = 0; i <= steps; ++i) {
    all.push_back(steps == 0 ? 0 : static_cast<int>(std::int64_t{room} * i / steps));
  }
  return all;
}

std::vector<float> taper_values(Taper taper, int side) {
  std::vector<float> values(static_cast<std::size_t>(side), 1.0F);
  if (taper == Taper::hann) {
    for (int i = 0; i < side; ++i) {
      values[static_cast<std::size_t>(i)] =
          static_cast<float>(std::pow(std::sin(std::numbers::pi * (i + 0.5) / side), 2));
    }
  }
  return values;
}

int checked_side(Extent size, const WelchOptions& options) {
  const int side = options.side == 0 ? welch_side(size) : options.side;
  if (side < 8 || !std::has_single_bit(static_cast<unsigned>(side)) || side > std::min(size.width, size.height)) {
    throw std::invalid_argument(
        fmt::format("blocks of side {} in an image of {}x{}: expected a power of two from 8 to {}", side, size.width,
                    size.height, std::min(size.width, size.height)));
  }
  if (!(options.overlap >= 0 && options.overlap < 1)) {
    throw std::invalid_argument(fmt::format("overlap = {}: expected a number in [0, 1)", options.overlap));
  }
  return side;
}

}  // namespace

int welch_side(Extent size) {
  return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(2, std::min(size.width, size.height)))) / 2);
}

WelchSpectrum::WelchSpectrum(const Image& u, const WelchOptions& options)
    : channels_(u.channels()), mean_(channel_means(u)) {
  const int side = checked_side(u.extent(), options);
  for (const int y : starts(u.height(), side, options.overlap)) {
    for (const int x : starts(u.width(), side, options.overlap)) {
      blocks_.push_back({x, y});
    }
    if (blocks_.size() > 65536) {
      throw std::invalid_argument(
          fmt::format("overlap = {} makes more than 65536 blocks: expected less", options.overlap));
    }
  }
  const std::vector<float> taper = taper_values(options.taper, side);
  double square = 0;
  for (const float t : taper) square += static_cast<double>(t) * static_cast<double>(t);
  const auto scale = static_cast<float>(1 / (square * square * static_cast<double>(blocks_.size())));

  for (int pair = 0; pair < channels_ * (channels_ + 1) / 2; ++pair) products_.emplace_back(Extent{side, side}, 1);
  for (const Pixel& corner : blocks_) {
    Image block = Image::uninitialized({side, side}, channels_);
    parallel_for(channels_ * side, [&](int i) {
      const int c = i / side, y = i % side;
      const auto from = u.row(c, corner.y + y).subspan(static_cast<std::size_t>(corner.x));
      const auto to = block.row(c, y);
      const auto mean = static_cast<float>(mean_[static_cast<std::size_t>(c)]);
      const float row = taper[static_cast<std::size_t>(y)];
      for (std::size_t x = 0; x < to.size(); ++x) to[x] = row * taper[x] * (from[x] - mean);
    });
    const Spectrum z = forward_fft(block);
    parallel_for(side, [&](int ky) {
      for (int c = 0; c < channels_; ++c) {
        for (int d = 0; d <= c; ++d) {
          const auto a = z.row(c, ky), b = z.row(d, ky);
          const auto sum = products_[pair(c, d)].row(0, ky);
          for (std::size_t kx = 0; kx < sum.size(); ++kx) {
            // a conj(b), written out: std::complex multiplies with a branch for infinities.
            sum[kx] += scale * std::complex<float>(a[kx].real() * b[kx].real() + a[kx].imag() * b[kx].imag(),
                                                   a[kx].imag() * b[kx].real() - a[kx].real() * b[kx].imag());
          }
        }
      }
    });
  }
}

Eigen::MatrixXcd WelchSpectrum::at(int kx, int ky) const {
  Eigen::MatrixXcd p(channels_, channels_);
  for (int c = 0; c < channels_; ++c) {
    for (int d = 0; d <= c; ++d) {
      const std::complex<double> value(products_[pair(c, d)].at(0, kx, ky));
      p(c, d) = value;
      p(d, c) = std::conj(value);
    }
  }
  return p;
}

double WelchSpectrum::power(int kx, int ky) const {
  double sum = 0;
  for (int c = 0; c < channels_; ++c) sum += static_cast<double>(products_[pair(c, c)].at(0, kx, ky).real());
  return sum;
}

}  // namespace textonbench
