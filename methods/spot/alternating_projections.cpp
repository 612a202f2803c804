#include "methods/spot/alternating_projections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <stdexcept>

#include "methods/base/box_fft.h"
#include "methods/base/lanes.h"
#include "methods/base/parallel.h"
#include "methods/spot/spline_spectrum.h"

namespace textonbench {
namespace {

constexpr int width = BinBlock::width;
using ColumnSums = std::array<double, width>;
template <class Number>
using ChannelPointers = std::array<Number*, Image::max_channels>;

/// Replaces the bins F of a block of columns by T s, and adds Σ_ky weights[ky] |F − T s|² to the sum of each column.
/// With the square of no difference of large numbers the sums are accurate however close the two are. Inlined, so that
/// loops over a constant number of channels unroll.
inline __attribute__((always_inline)) void project_bins(int channels, const ChannelPointers<const float>& spot,
                                                        const std::vector<float>& weights,
                                                        const ChannelPointers<float>& texton, ColumnSums& sums) {
  const int rows = static_cast<int>(weights.size());
  constexpr float smallest = 1e-36F;  // squares below are not normal numbers
  for (int ky = 0; ky < rows; ++ky) {
    const std::ptrdiff_t k = std::ptrdiff_t{ky} * 2 * width;
    FloatLanes t_re[Image::max_channels];
    FloatLanes t_im[Image::max_channels];
    FloatLanes f_re[Image::max_channels];
    FloatLanes f_im[Image::max_channels];
    FloatLanes re{};
    FloatLanes im{};
    for (int i = 0; i < channels; ++i) {
      const auto c = static_cast<std::size_t>(i);
      load(spot[c] + k, t_re[c]);
      load(spot[c] + k + width, t_im[c]);
      load(texton[c] + k, f_re[c]);
      load(texton[c] + k + width, f_im[c]);
      re += t_re[c] * f_re[c] + t_im[c] * f_im[c];
      im += t_re[c] * f_im[c] - t_im[c] * f_re[c];
    }
    const FloatLanes norm = re * re + im * im;
    FloatLanes root;
    for (int i = 0; i < width; ++i) {
      root[i] = std::sqrt(norm[i]);
    }
    const FloatLanes phase_re = norm < smallest ? FloatLanes{} + 1.0F : re / root;
    const FloatLanes phase_im = norm < smallest ? FloatLanes{} : im / root;
    FloatLanes distance{};
    for (int i = 0; i < channels; ++i) {
      const auto c = static_cast<std::size_t>(i);
      const FloatLanes new_re = t_re[c] * phase_re - t_im[c] * phase_im;
      const FloatLanes new_im = t_re[c] * phase_im + t_im[c] * phase_re;
      const FloatLanes off_re = f_re[c] - new_re;
      const FloatLanes off_im = f_im[c] - new_im;
      distance += off_re * off_re + off_im * off_im;
      store(new_re, texton[c] + k);
      store(new_im, texton[c] + k + width);
    }
    distance *= weights[static_cast<std::size_t>(ky)];
    for (int i = 0; i < width; ++i) {
      sums[static_cast<std::size_t>(i)] += static_cast<double>(distance[i]);
    }
  }
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void project_gray(const ChannelPointers<const float>& spot,
                                                                               const std::vector<float>& weights,
                                                                               const ChannelPointers<float>& texton,
                                                                               ColumnSums& sums) {
  project_bins(1, spot, weights, texton, sums);
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void project_color(
    const ChannelPointers<const float>& spot, const std::vector<float>& weights, const ChannelPointers<float>& texton,
    ColumnSums& sums) {
  project_bins(3, spot, weights, texton, sums);
}

__attribute__((target_clones("default", "avx2", "avx512f"))) void project_stack(
    int channels, const ChannelPointers<const float>& spot, const std::vector<float>& weights,
    const ChannelPointers<float>& texton, ColumnSums& sums) {
  project_bins(channels, spot, weights, texton, sums);
}

/// The projection of spectra onto those of modulus T = T_u / b̂^{1/2}, block of columns by block.
class Projection {
 public:
  Projection(const Spectrum& spot, int order)
      : layout_(spot), gain_(order, spot.raster()), sums_(static_cast<std::size_t>(spot.columns() / width + 1)) {
    row_weights_.reserve(static_cast<std::size_t>(spot.rows()));
    for (int ky = 0; ky < spot.rows(); ++ky) {
      row_weights_.push_back(static_cast<float>(gain_.row(ky) * gain_.row(ky)));
    }
    blocks_.reserve(sums_.size());
    for (int first = 0; first < spot.columns(); first += width) {
      blocks_.emplace_back(spot.rows(), spot.channels());
      for (int c = 0; c < spot.channels(); ++c) {
        copy_columns(spot, c, first, blocks_.back());
        divide_by_gain(first, blocks_.back().bins(c));
      }
    }
    for (int c = 0; c < spot.channels(); ++c) {
      for (int ky = 0; ky < spot.rows(); ++ky) {
        for (int kx = 0; kx < spot.columns(); ++kx) {
          energy_ += spot.multiplicity(kx) * std::norm(std::complex<double>(spot.at(c, kx, ky)));
        }
      }
    }
  }

  void operator()(int first, const BinBlock& block) {
    for (int c = 0; c < layout_.channels() && first == 0; ++c) {
      block.bins(c)[0] = block.bins(c)[width] = 0;  // the error leaves ξ = 0 out
    }
    const auto number = static_cast<std::size_t>(first / width);
    ChannelPointers<const float> in{};
    ChannelPointers<float> out{};
    for (int i = 0; i < layout_.channels(); ++i) {
      const auto c = static_cast<std::size_t>(i);
      in[c] = blocks_[number].bins(i);
      out[c] = block.bins(i);
    }
    ColumnSums sums{};
    if (layout_.channels() == 1) {
      project_gray(in, row_weights_, out, sums);
    } else if (layout_.channels() == 3) {
      project_color(in, row_weights_, out, sums);
    } else {
      project_stack(layout_.channels(), in, row_weights_, out, sums);
    }
    sums_[number] = sums;
  }

  /// RME of the spectrum that was projected last: its distance to its projection, weighted by b̂, is that of the two
  /// models, since the projection has modulus T and the phases that fit best.
  double relative_error() const {
    double sum = 0;
    for (int kx = 0; kx < layout_.columns(); ++kx) {
      sum += layout_.multiplicity(kx) * gain_.column(kx) * gain_.column(kx) *
             sums_[static_cast<std::size_t>(kx / width)][static_cast<std::size_t>(kx % width)];
    }
    return std::sqrt(sum / energy_);
  }

 private:
  void divide_by_gain(int first, float* bins) const {
    const int columns = std::min(width, layout_.columns() - first);
    for (int ky = 0; ky < layout_.rows(); ++ky) {
      for (int i = 0; i < columns; ++i) {
        const auto gain = static_cast<float>(gain_.column(first + i) * gain_.row(ky));
        bins[std::ptrdiff_t{ky} * 2 * width + i] /= gain;
        bins[std::ptrdiff_t{ky} * 2 * width + width + i] /= gain;
      }
    }
  }

  const Spectrum& layout_;
  SplineGain gain_;
  std::vector<float> row_weights_;  ///< b̂1 of every row
  std::vector<BinBlock> blocks_;    ///< T
  std::vector<ColumnSums> sums_;    ///< squared distance of each column of each block, weighted by rows only
  double energy_ = 0;
};

/// What a pixel of the box is multiplied by: the scale of the inverse transform in S, zero outside.
std::vector<float> support_weights(const Support& support, Extent raster) {
  const auto scale = static_cast<float>(1.0 / static_cast<double>(raster.area()));
  std::vector<float> weights(support.inside.size());
  std::ranges::transform(support.inside, weights.begin(), [&](std::uint8_t inside) { return inside != 0 ? scale : 0; });
  return weights;
}

void restrict_to_support(const std::vector<float>& weights, Image& texton) {
  for (int c = 0; c < texton.channels(); ++c) {
    auto weight = weights.begin();
    for (int y = 0; y < texton.height(); ++y) {
      for (float& value : texton.row(c, y)) {
        value *= *weight++;
      }
    }
  }
}

void require_projectable(const GaussianModel& model, const Support& support, const Spectrum& start,
                         const ProjectionOptions& options) {
  const Spectrum& spot = model.spectrum.factors.front();
  const auto require = [](bool met, const std::string& message) {
    if (!met) {
      throw std::invalid_argument("alternating projections: " + message);
    }
  };
  require(model.spectrum.factors.size() == 1,
          fmt::format("a model of {} factors, expected 1", model.spectrum.factors.size()));
  require(
      start.raster() == spot.raster() && start.channels() == spot.channels(),
      fmt::format("a start of {}x{}x{}, expected the exemplar's {}x{}x{}", start.raster().width, start.raster().height,
                  start.channels(), spot.raster().width, spot.raster().height, spot.channels()));
  require(support.pixels >= 1, "an empty support");
  require(options.iterations >= 1, fmt::format("{} iterations, expected at least 1", options.iterations));
  require(options.tolerance >= 0 && options.tolerance < 1,
          fmt::format("tolerance {}, expected a number in [0, 1)", options.tolerance));
}

/// White Gaussian noise of one raster.
Image white_noise(Extent extent, int channels, const Stream& stream) {
  Image noise(extent, channels);
  parallel_for(channels * extent.height, [&](int i) {
    const int c = i / extent.height;
    const int y = i % extent.height;
    fill_normal(stream.child(static_cast<std::uint64_t>(c)), static_cast<std::uint64_t>(y), 0, noise.row(c, y));
  });
  return noise;
}

}  // namespace

ProjectedTexton alternate_projections(const GaussianModel& model, const Support& support, const Spectrum& start,
                                      const ProjectionOptions& options) {
  require_projectable(model, support, start, options);
  const Spectrum& spot = model.spectrum.factors.front();
  const std::vector<float> weights = support_weights(support, spot.raster());
  Projection projection(spot, options.order);

  const BlockMap project = std::ref(projection);

  Image kernel = unnormalized_inverse_fft_in_box(start, support.box, project);
  restrict_to_support(weights, kernel);

  ProjectionSummary summary;
  std::vector<double>& rme = summary.rme;
  for (summary.iterations = 1; summary.iterations < options.iterations; ++summary.iterations) {
    const std::size_t known = rme.size();
    if (options.tolerance > 0 && known >= 2 && rme[known - 2] - rme[known - 1] <= options.tolerance * rme[known - 2]) {
      summary.stop = ProjectionSummary::Stop::tolerance;
      break;
    }
    map_box_spectrum(kernel, spot.raster(), project);
    restrict_to_support(weights, kernel);
    rme.push_back(projection.relative_error());
  }

  ProjectedTexton result{{{}, support.pixels, model.mean}, std::move(summary)};
  result.texton.kernels.push_back(kernel);
  map_box_spectrum(kernel, spot.raster(), project);
  result.summary.rme.push_back(projection.relative_error());
  return result;
}

Spectrum random_phase_start(const Spectrum& spot, Seed seed) {
  // Only the phases of the noise count: the first projection restores the modulus.
  const Spectrum noise = forward_fft(white_noise(spot.raster(), 1, Stream(seed).child("random phase start")));
  Spectrum start = spot;
  for (int c = 0; c < spot.channels(); ++c) {
    parallel_for(spot.rows(), [&](int ky) {
      const auto phase = noise.row(0, ky);
      const auto row = start.row(c, ky);
      for (std::size_t kx = 0; kx < row.size(); ++kx) {
        row[kx] *= phase[kx];
      }
    });
  }
  return start;
}

Spectrum white_start(const Spectrum& spot, Seed seed) {
  return forward_fft(white_noise(spot.raster(), spot.channels(), Stream(seed).child("white start")));
}

}  // namespace textonbench
