#include "methods/base/spectrum.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace textonbench {
namespace {

std::vector<double> cosines(int n) {
  std::vector<double> table(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) {
    table[static_cast<std::size_t>(k)] = 2 * std::cos(2 * std::numbers::pi * k / n);
  }
  return table;
}

/// Value of each bin of a half spectrum, or of its mirror image, frequency zero at (W / 2, H / 2).
template <class Value>
Image centered_picture(Extent size, int channels, const Value& value) {
  Image picture(size, channels);
  const int w = size.width;
  const int h = size.height;
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < h; ++y) {
      const int ky = (y - h / 2 + h) % h;
      for (int x = 0; x < w; ++x) {
        const int kx = (x - w / 2 + w) % w;
        const bool mirrored = kx > w / 2;
        picture.at(c, x, y) = mirrored ? value(c, w - kx, (h - ky) % h, mirrored) : value(c, kx, ky, mirrored);
      }
    }
  }
  return picture;
}

/// log10 of a half spectrum of power below its largest value, over five decades.
Image power_picture(const Image& power, Extent size) {
  float largest = 0;
  for (int c = 0; c < power.channels(); ++c) {
    for (int y = 0; y < power.height(); ++y) {
      largest = std::max(largest, std::ranges::max(power.row(c, y)));
    }
  }
  constexpr double decades = 5;
  return centered_picture(size, power.channels(), [&](int c, int kx, int ky, bool) {
    const double relative = largest > 0 ? double{power.at(c, kx, ky)} / double{largest} : 0;
    return static_cast<float>(std::clamp(1 + std::log10(std::max(relative, 1e-30)) / decades, 0.0, 1.0));
  });
}

/// Jumps between opposite borders, on the border pixels; zero inside.
Image border_jumps(const Image& u) {
  const int w = u.width();
  const int h = u.height();
  Image jumps(u.extent(), u.channels());
  for (int c = 0; c < u.channels(); ++c) {
    for (int x = 0; x < w; ++x) {
      const float jump = u.at(c, x, h - 1) - u.at(c, x, 0);
      jumps.at(c, x, 0) += jump;
      jumps.at(c, x, h - 1) -= jump;
    }
    for (int y = 0; y < h; ++y) {
      const float jump = u.at(c, w - 1, y) - u.at(c, 0, y);
      jumps.at(c, 0, y) += jump;
      jumps.at(c, w - 1, y) -= jump;
    }
  }
  return jumps;
}

}  // namespace

std::vector<double> channel_means(const Image& u) {
  std::vector<double> means;
  for (int c = 0; c < u.channels(); ++c) {
    double sum = 0;
    for (int y = 0; y < u.height(); ++y) {
      double row_sum = 0;
      for (const float v : u.row(c, y)) {
        row_sum += v;
      }
      sum += row_sum;
    }
    means.push_back(sum / static_cast<double>(u.extent().area()));
  }
  return means;
}

Image periodogram(const Image& u) {
  const Spectrum s = forward_fft(u);
  Image power({s.columns(), s.rows()}, u.channels());
  const auto scale = static_cast<float>(1.0 / static_cast<double>(u.extent().area()));
  for (int c = 0; c < u.channels(); ++c) {
    for (int ky = 0; ky < s.rows(); ++ky) {
      std::ranges::transform(s.row(c, ky), power.row(c, ky).begin(),
                             [&](std::complex<float> bin) { return std::norm(bin) * scale; });
    }
    power.at(c, 0, 0) = 0;
  }
  return power;
}

Image periodic_component(const Image& u) {
  const int w = u.width();
  const int h = u.height();
  // The smooth component s solves Δ s = v on the torus, where v holds the border jumps; its DFT is
  // v̂ / (2 cos(2πkx/W) + 2 cos(2πky/H) − 4), and 0 at frequency 0. The periodic component is u − s.
  Spectrum s = forward_fft(border_jumps(u));
  const std::vector<double> cos_x = cosines(w);
  const std::vector<double> cos_y = cosines(h);
  for (int c = 0; c < u.channels(); ++c) {
    for (int ky = 0; ky < h; ++ky) {
      const auto row = s.row(c, ky);
      for (std::size_t kx = 0; kx < row.size(); ++kx) {
        const double laplacian = cos_x[kx] + cos_y[static_cast<std::size_t>(ky)] - 4;
        row[kx] = kx == 0 && ky == 0 ? 0.0F : row[kx] * static_cast<float>(1 / laplacian);
      }
    }
  }
  Image p = inverse_fft(s);
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < h; ++y) {
      std::ranges::transform(u.row(c, y), p.row(c, y), p.row(c, y).begin(),
                             [](float value, float smooth) { return value - smooth; });
    }
  }
  return p;
}

Image modulus_picture(const Image& u) { return power_picture(periodogram(u), u.extent()); }

Image mean_modulus_picture(std::span<const Image> images) {
  Image sum = periodogram(periodic_component(images.front()));
  for (const Image& image : images.subspan(1)) {
    const Image power = periodogram(periodic_component(image));
    for (int c = 0; c < sum.channels(); ++c) {
      for (int y = 0; y < sum.height(); ++y) {
        std::ranges::transform(sum.row(c, y), power.row(c, y), sum.row(c, y).begin(), std::plus<>());
      }
    }
  }
  return power_picture(sum, images.front().extent());
}

Image phase_picture(const Image& u) {
  const Spectrum s = forward_fft(u);
  return centered_picture(u.extent(), u.channels(), [&](int c, int kx, int ky, bool mirrored) {
    const float phase = std::arg(mirrored ? std::conj(s.at(c, kx, ky)) : s.at(c, kx, ky));
    return static_cast<float>(phase / (2 * std::numbers::pi) + 0.5);
  });
}

}  // namespace textonbench
