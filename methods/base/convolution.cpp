#include "methods/base/convolution.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "methods/base/parallel.h"

namespace textonbench {
namespace {

/// p_c *= w for every channel c.
void multiply_channels(Spectrum& p, const Spectrum& w) {
  parallel_for(p.channels() * p.rows(), [&](int i) {
    const auto noise = w.row(0, i % p.rows());
    const auto row = p.row(i / p.rows(), i % p.rows());
    for (std::size_t kx = 0; kx < row.size(); ++kx) {
      row[kx] = {row[kx].real() * noise[kx].real() - row[kx].imag() * noise[kx].imag(),
                 row[kx].real() * noise[kx].imag() + row[kx].imag() * noise[kx].real()};
    }
  });
}

void add_spectrum(Spectrum& sum, const Spectrum& term) {
  parallel_for(sum.channels() * sum.rows(), [&](int i) {
    const auto from = term.row(i / sum.rows(), i % sum.rows());
    const auto to = sum.row(i / sum.rows(), i % sum.rows());
    std::ranges::transform(to, from, to.begin(), std::plus<>());
  });
}

Image convolve_on(Extent grid, std::span<const Image> kernels, std::span<const Image> fields) {
  Spectrum sum;
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    Spectrum product = forward_fft(wrap(kernels[k], grid));
    multiply_channels(product, forward_fft(wrap(fields[k], grid)));
    if (k == 0) {
      sum = std::move(product);
    } else {
      add_spectrum(sum, product);
    }
  }
  return inverse_fft(sum);
}

}  // namespace

Image wrap(const Image& image, Extent grid) {
  Image wrapped(grid, image.channels());
  for (int c = 0; c < image.channels(); ++c) {
    for (int y = 0; y < image.height(); ++y) {
      const auto to = wrapped.row(c, y % grid.height);
      for (auto rest = std::span<const float>(image.row(c, y)); !rest.empty();) {
        const auto turn = rest.first(std::min(rest.size(), to.size()));
        std::ranges::transform(turn, to, to.begin(), std::plus<>());
        rest = rest.subspan(turn.size());
      }
    }
  }
  return wrapped;
}

void add_constant(std::span<const double> constant, Image& image) {
  parallel_for(image.channels() * image.height(), [&](int i) {
    const int channel = i / image.height();
    const auto value = static_cast<float>(constant[static_cast<std::size_t>(channel)]);
    for (float& v : image.row(channel, i % image.height())) {
      v += value;
    }
  });
}

Extent convolution_grid(Extent kernel, Extent window) {
  return {good_fft_size(window.width + kernel.width - 1), good_fft_size(window.height + kernel.height - 1)};
}

Image convolve_valid(std::span<const Image> kernels, std::span<const Image> fields) {
  const auto [width, height] = kernels.front().extent();
  const Extent window{fields.front().width() - width + 1, fields.front().height() - height + 1};
  return crop(convolve_on(convolution_grid(kernels.front().extent(), window), kernels, fields), width - 1, height - 1,
              window);
}

Image convolve_circular(std::span<const Image> kernels, std::span<const Image> fields) {
  return convolve_on(fields.front().extent(), kernels, fields);
}

}  // namespace textonbench
