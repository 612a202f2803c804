#include "experiments/metrics/spot_samples.h"

#include <algorithm>
#include <cstdlib>

#include "methods/base/fft.h"
#include "methods/spot/impacts.h"

namespace textonbench {

Image raw_spot_noise(const Image& kernel, double intensity, const Stream& stream, Extent window) {
  const int width = kernel.width(), height = kernel.height();
  const PlaneWindow reach{1 - width, 1 - height, {window.width + width - 1, window.height + height - 1}};
  Image sum(window, kernel.channels());
  for (const ImpactStrip& strip : draw_poisson(stream, intensity, 1, reach).strips) {
    for (const Impact& impact : strip.impacts) {
      const int left = impact.x + 1 - width, top = impact.y + 1 - height;
      const int first = std::max(0, -left), end = std::min(width, window.width - left);
      for (int c = 0; c < kernel.channels(); ++c) {
        for (int y = std::max(0, -top); y < std::min(height, window.height - top); ++y) {
          const float* from = kernel.row(c, y).data();
          float* to = sum.row(c, top + y).data() + left;
          for (int x = first; x < end; ++x) to[x] += impact.weight * from[x];
        }
      }
    }
  }
  return sum;
}

std::vector<float> lag_products(const Image& u, int reach) {
  const Extent torus{good_fft_size(u.width() + reach), good_fft_size(u.height() + reach)};
  Image padded(torus, u.channels());
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < u.height(); ++y) std::ranges::copy(u.row(c, y), padded.row(c, y).begin());
  }
  Spectrum power = forward_fft(padded);
  for (int c = 0; c < power.channels(); ++c) {
    for (int ky = 0; ky < power.rows(); ++ky) {
      for (std::complex<float>& value : power.row(c, ky)) value = std::norm(value);
    }
  }
  const Image sums = inverse_fft(power);
  std::vector<float> products;
  products.reserve(static_cast<std::size_t>(u.channels()) * static_cast<std::size_t>((2 * reach + 1) * (reach + 1)));
  for (int c = 0; c < u.channels(); ++c) {
    for_each_lag(reach, [&](int x, int y) {
      const float pairs = static_cast<float>(u.width() - std::abs(x)) * static_cast<float>(u.height() - y);
      products.push_back(sums.at(c, x < 0 ? x + torus.width : x, y) / pairs);
    });
  }
  return products;
}

double autocorrelation(const Image& kernel, int channel, int x, int y) {
  double sum = 0;
  for (int row = std::max(0, -y); row < std::min(kernel.height(), kernel.height() - y); ++row) {
    for (int column = std::max(0, -x); column < std::min(kernel.width(), kernel.width() - x); ++column) {
      sum += static_cast<double>(kernel.at(channel, column, row)) *
             static_cast<double>(kernel.at(channel, column + x, row + y));
    }
  }
  return sum;
}

}  // namespace textonbench
