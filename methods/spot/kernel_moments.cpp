#include "methods/spot/kernel_moments.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <utility>

#include "methods/base/fft.h"

namespace textonbench {
namespace {

/// Σ_k Σ_x h_k^n of one channel.
double power_sum(const Texton& texton, int channel, int n) {
  double sum = 0;
  for (const Image& kernel : texton.kernels) {
    for (int y = 0; y < kernel.height(); ++y) {
      double row_sum = 0;
      for (const double v : kernel.row(channel, y)) {
        const double square = v * v;
        row_sum += n == 2 ? square : n == 3 ? square * v : square * square;
      }
      sum += row_sum;
    }
  }
  return sum;
}

/// s = Σ_k h_k² of one channel.
Eigen::MatrixXd energy_of(const Texton& texton, int channel) {
  const auto [width, height] = texton.extent();
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(height, width);
  for (const Image& kernel : texton.kernels) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double v = kernel.at(channel, x, y);
        energy(y, x) += v * v;
      }
    }
  }
  return energy;
}

/// R_s.
Image overlap_of(const Eigen::MatrixXd& energy) {
  const auto width = static_cast<int>(energy.cols());
  const auto height = static_cast<int>(energy.rows());
  Image padded({good_fft_size(2 * width - 1), good_fft_size(2 * height - 1)}, 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      padded.at(0, x, y) = static_cast<float>(energy(y, x));
    }
  }
  Spectrum spectrum = forward_fft(padded);
  for (int ky = 0; ky < spectrum.rows(); ++ky) {
    for (std::complex<float>& bin : spectrum.row(0, ky)) {
      bin = std::norm(bin);
    }
  }
  return inverse_fft(spectrum);
}

/// Entry (c, j): the part of the cell number c, of those that reach, whose points are at `pixel` − j.
Eigen::MatrixXd cell_weights(const CellAxis& axis, std::int64_t pixel, int kernel_length) {
  const std::int64_t p = axis.numerator;
  const std::int64_t q = axis.denominator;
  // Moved by whole cells so that all numbers are positive.
  const std::int64_t shifted = pixel + p * kernel_length;
  const std::int64_t first = (shifted - kernel_length + 1) * q / p;
  const std::int64_t last = ((shifted + 1) * q - 1) / p;
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(last - first + 1, kernel_length);
  for (int j = 0; j < kernel_length; ++j) {
    const std::int64_t begin = (shifted - j) * q;
    for (std::int64_t cell = begin / p; cell * p < begin + q; ++cell) {
      const std::int64_t shared = std::min((cell + 1) * p, begin + q) - std::max(cell * p, begin);
      weights(cell - first, j) = static_cast<double>(shared) / static_cast<double>(p);
    }
  }
  return weights;
}

/// Up to 24 pixels spread over three cells.
std::vector<std::int64_t> sample_pixels(const CellAxis& axis) {
  const auto length = std::max<std::int64_t>(3, std::llround(3 * axis.side()));
  const std::int64_t step = (length + 23) / 24;
  std::vector<std::int64_t> pixels;
  pixels.reserve(24);
  for (std::int64_t pixel = 0; pixel < length; pixel += step) {
    pixels.push_back(pixel);
  }
  return pixels;
}

double largest_excess(const std::vector<NoiseMoments>& channels) {
  double largest = 0;
  for (const NoiseMoments& moments : channels) {
    largest = std::max(largest, std::fabs(moments.excess_kurtosis));
  }
  return largest;
}

}  // namespace

std::vector<NoiseMoments> poisson_moments(const Texton& texton, double mni) {
  const double intensity = mni / static_cast<double>(texton.support_pixels);
  const auto kernels = static_cast<double>(texton.kernels.size());
  std::vector<NoiseMoments> moments(static_cast<std::size_t>(texton.channels()));
  for (int c = 0; c < texton.channels(); ++c) {
    const double energy = power_sum(texton, c, 2);
    if (energy > 0) {
      moments[static_cast<std::size_t>(c)] = {
          std::sqrt(kernels / intensity) * power_sum(texton, c, 3) / std::pow(energy, 1.5),
          kernels * power_sum(texton, c, 4) / (intensity * energy * energy)};
    }
  }
  return moments;
}

std::vector<double> cell_difference_law(const CellAxis& axis) {
  // In steps of 1 / q pixel a cell has p of them, from step f of its first pixel on; the cells take all f that are
  // multiples of gcd(p, q) equally often. Its pixels have b, q, …, q, e steps.
  const std::int64_t p = axis.numerator;
  const std::int64_t q = axis.denominator;
  const std::int64_t phase = std::gcd(p, q);
  std::vector<double> law(static_cast<std::size_t>((p + q - phase - 1) / q + 1));
  const double weight =
      static_cast<double>(phase) / (static_cast<double>(q) * static_cast<double>(p) * static_cast<double>(p));
  for (std::int64_t f = 0; f < q; f += phase) {
    const std::int64_t last = (f + p - 1) / q;
    if (last == 0) {
      law[0] += weight * static_cast<double>(p) * static_cast<double>(p);
      continue;
    }
    const auto whole = static_cast<double>(q);
    const auto begin = static_cast<double>(q - f);
    const auto end = static_cast<double>(f + p - last * q);
    law[0] += weight * (begin * begin + static_cast<double>(last - 1) * whole * whole + end * end);
    for (std::int64_t v = 1; v < last; ++v) {
      law[static_cast<std::size_t>(v)] += weight * whole * (begin + end + static_cast<double>(last - 1 - v) * whole);
    }
    law[static_cast<std::size_t>(last)] += weight * begin * end;
  }
  return law;
}

StratifiedMoments::StratifiedMoments(const Texton& texton) : extent_(texton.extent()) {
  const auto kernels = static_cast<double>(texton.kernels.size());
  channels_.reserve(static_cast<std::size_t>(texton.channels()));
  for (int c = 0; c < texton.channels(); ++c) {
    Eigen::MatrixXd energy = energy_of(texton, c);
    Image overlap = overlap_of(energy);
    channels_.push_back({kernels * power_sum(texton, c, 4), energy.sum(), std::move(energy), std::move(overlap)});
  }
}

std::vector<NoiseMoments> StratifiedMoments::on(const CellLattice& lattice) const {
  const std::vector<double> across = cell_difference_law(lattice.x);
  const std::vector<double> down = cell_difference_law(lattice.y);
  const int last_x = std::min(static_cast<int>(across.size()), extent_.width) - 1;
  const int last_y = std::min(static_cast<int>(down.size()), extent_.height) - 1;
  std::vector<NoiseMoments> moments(channels_.size());
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Channel& channel = channels_[c];
    if (channel.energy <= 0) {
      continue;
    }
    const auto [period_x, period_y] = channel.overlap.extent();
    double cells = 0;
    for (int y = -last_y; y <= last_y; ++y) {
      double row_sum = 0;
      for (int x = -last_x; x <= last_x; ++x) {
        row_sum += channel.overlap.at(0, (x + period_x) % period_x, (y + period_y) % period_y) *
                   across[static_cast<std::size_t>(std::abs(x))];
      }
      cells += row_sum * down[static_cast<std::size_t>(std::abs(y))];
    }
    moments[c].excess_kurtosis = (channel.fourth - 3 * cells) / (lattice.intensity() * channel.energy * channel.energy);
  }
  return moments;
}

std::vector<KurtosisRange> StratifiedMoments::range_on(const CellLattice& lattice) const {
  std::vector<Eigen::MatrixXd> across;
  std::vector<Eigen::MatrixXd> down;
  across.reserve(24);
  down.reserve(24);
  for (const std::int64_t pixel : sample_pixels(lattice.x)) {
    across.push_back(cell_weights(lattice.x, pixel, extent_.width));
  }
  for (const std::int64_t pixel : sample_pixels(lattice.y)) {
    down.push_back(cell_weights(lattice.y, pixel, extent_.height));
  }
  std::vector<KurtosisRange> ranges(channels_.size());
  const double intensity = lattice.intensity();
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const Channel& channel = channels_[c];
    if (channel.energy <= 0) {
      continue;
    }
    double least = std::numeric_limits<double>::infinity();
    double greatest = -least;
    for (const Eigen::MatrixXd& rows : down) {
      const Eigen::MatrixXd of_rows = rows * channel.s;
      for (const Eigen::MatrixXd& columns : across) {
        // Σ_c (E s over the cell)² at one pixel.
        const double cells = (of_rows * columns.transpose()).squaredNorm();
        const double excess = (intensity * channel.fourth - 3 * cells) / std::pow(intensity * channel.energy, 2);
        least = std::min(least, excess);
        greatest = std::max(greatest, excess);
      }
    }
    ranges[c] = {least, greatest};
  }
  return ranges;
}

double poisson_impacts_needed(const Texton& texton, double bound) {
  return largest_excess(poisson_moments(texton, 1)) / bound;
}

double stratified_impacts_needed(const Texton& texton, double bound) {
  // Of a cell, 0 <= (E g²)² <= E g⁴: the excess kurtosis is between −2 times and 1 times that of Poisson impacts, so
  // twice as many as those need are enough.
  const StratifiedMoments moments(texton);
  const auto support = static_cast<double>(texton.support_pixels);
  double needed = std::max(1.0, std::min(2 * poisson_impacts_needed(texton, bound), 64 * support));
  while (needed > 1 && largest_excess(moments.on(plane_lattice(needed / 1.01 / support))) < bound) {
    needed /= 1.01;
  }
  return std::max(needed, 1.0);
}

}  // namespace textonbench
