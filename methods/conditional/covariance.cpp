#include "methods/conditional/covariance.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>

#include "methods/base/fft.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

/// The side of the torus on which lags of a box are applied.
int grid_side(bool periodic, int torus, int box) {
  const int wanted = good_fft_size(2 * box - 1);
  return periodic && torus <= wanted ? torus : wanted;
}

Extent grid_size(bool periodic, Extent torus, Extent box) {
  if (periodic && (box.width > torus.width || box.height > torus.height)) {
    throw std::invalid_argument(fmt::format("a box of {}x{} on a torus of {}x{}: expected one that fits", box.width,
                                            box.height, torus.width, torus.height));
  }
  return {grid_side(periodic, torus.width, box.width), grid_side(periodic, torus.height, box.height)};
}

/// One line of the autocorrelation: the sizes of spot, torus (of a periodic field) and box along it.
int spot_side(bool periodic, int torus, int spot, int box) {
  // Lags below the box are free of what wraps around from here on.
  return periodic ? torus : good_fft_size(spot + std::min(spot, box) - 1);
}

/// The spot on the raster on which its autocorrelation is computed: on a torus, pixels equal modulo its size are added.
Planes placed(const Planes& spot, Extent raster) {
  Planes result({std::min(spot.extent.width, raster.width), std::min(spot.extent.height, raster.height)},
                spot.channels);
  for (int c = 0; c < spot.channels; ++c) {
    for (int y = 0; y < spot.extent.height; ++y) {
      const double* in = spot.row(c, y);
      double* out = result.row(c, y % raster.height);
      for (int x = 0; x < spot.extent.width; ++x) out[x % raster.width] += in[x];
    }
  }
  return result;
}

std::size_t bin_count(const BoxTransform& transform) {
  return static_cast<std::size_t>(transform.columns()) * static_cast<std::size_t>(transform.grid().height);
}

std::vector<Bins> spectra(const Planes& fields, const BoxTransform& transform, BoxTransform::Workspace& workspace) {
  std::vector<Bins> result(static_cast<std::size_t>(fields.channels), Bins(bin_count(transform)));
  transform.forward(
      fields,
      [&](const SpectrumColumns& block) {
        for_columns(block, transform.columns(), [&](int i, std::size_t n) {
          for (int c = 0; c < fields.channels; ++c) {
            std::copy_n(block.column(c, i), block.height, result[static_cast<std::size_t>(c)].data() + n);
          }
        });
      },
      workspace);
  return result;
}

/// Lags of size |v| < reach of `lags` (first lag (0, 0), |v| wrapped around its raster) on the grid, zero elsewhere.
Planes cut_off(const Planes& lags, Extent reach, Extent grid) {
  Planes result(grid, 1);
  for (int vy = 1 - reach.height; vy < reach.height; ++vy) {
    const double* in = lags.row(0, (vy + lags.extent.height) % lags.extent.height);
    double* out = result.row(0, (vy + grid.height) % grid.height);
    for (int vx = 1 - reach.width; vx < reach.width; ++vx) {
      out[(vx + grid.width) % grid.width] = in[(vx + lags.extent.width) % lags.extent.width];
    }
  }
  return result;
}

}  // namespace

std::vector<Bins> spot_spectrum(const Planes& spot, Extent raster) {
  BoxTransform::Workspace workspace;
  const Planes wrapped = placed(spot, raster);
  return spectra(wrapped, BoxTransform(raster, wrapped.extent), workspace);
}

CovarianceTable::CovarianceTable(Extent reach, int channels)
    : reach_(reach),
      channels_(channels),
      planes_(static_cast<std::size_t>((2 * std::int64_t{reach.width} - 1) * (2 * std::int64_t{reach.height} - 1) *
                                       channels * channels)) {}

BoxCovariance::BoxCovariance(const GaussianField& field, Extent torus, Extent box)
    : transform_(grid_size(field.periodic, torus, box), box), channels_(field.channels()) {
  const Extent raster{spot_side(field.periodic, torus.width, field.spot.extent.width, box.width),
                      spot_side(field.periodic, torus.height, field.spot.extent.height, box.height)};
  Workspace workspace;
  const std::vector<Bins> t = spot_spectrum(field.spot, raster);
  const BoxTransform of_lags(raster, raster);
  const BoxTransform of_grid(grid(), grid());
  const double scale = 1 / static_cast<double>(raster.area()) / static_cast<double>(grid().area());
  // On the plane lags as large as the spot are zero, and may not have a place on its raster.
  const Extent reach = field.periodic ? box
                                      : Extent{std::min(box.width, field.spot.extent.width),
                                               std::min(box.height, field.spot.extent.height)};
  for (int c = 0; c < channels_; ++c) {
    for (int d = c; d < channels_; ++d) {
      const Bins& a = t[static_cast<std::size_t>(c)];
      const Bins& b = t[static_cast<std::size_t>(d)];
      Planes product(raster, 1);
      of_lags.inverse(
          [&](const SpectrumColumns& block) {
            for_columns(block, of_lags.columns(), [&](int i, std::size_t n) {
              std::complex<double>* out = block.column(0, i);
              for (int y = 0; y < block.height; ++y) out[y] = a[n + y] * std::conj(b[n + y]);
            });
          },
          product, workspace);
      const Planes lags = grid() == raster ? std::move(product) : cut_off(product, reach, grid());
      const Bins bins = spectra(lags, of_grid, workspace).front();
      if (c == d) {
        std::vector<double>& real = diagonal_.emplace_back(bins.size());
        std::transform(bins.begin(), bins.end(), real.begin(),
                       [&](const std::complex<double>& bin) { return scale * bin.real(); });
      } else {
        Bins& scaled = off_diagonal_.emplace_back(bins.size());
        std::transform(bins.begin(), bins.end(), scaled.begin(),
                       [&](const std::complex<double>& bin) { return scale * bin; });
      }
    }
  }
}

std::size_t BoxCovariance::bytes() const {
  return bin_count(transform_) * (diagonal_.size() * sizeof(double) + off_diagonal_.size() * 2 * sizeof(double));
}

namespace {

/// out_c = Σ_d Γ̂_cd p_d at the bins of a column, in place.
template <int channels>
void multiply(const SpectrumColumns& block, int i, std::size_t n, std::span<const std::vector<double>> diagonal,
              std::span<const Bins> off_diagonal) {
  constexpr int pairs = channels * (channels - 1) / 2;
  double* p[channels];
  const double* own[channels];
  const double* between[pairs + 1];
  for (int c = 0; c < channels; ++c) {
    p[c] = reinterpret_cast<double*>(block.column(c, i));
    own[c] = diagonal[static_cast<std::size_t>(c)].data() + n;
  }
  for (int k = 0; k < pairs; ++k) {
    between[k] = reinterpret_cast<const double*>(off_diagonal[static_cast<std::size_t>(k)].data() + n);
  }
  for (std::ptrdiff_t y = 0; y < block.height; ++y) {
    double re[channels], im[channels], out_re[channels], out_im[channels];
    for (int c = 0; c < channels; ++c) {
      re[c] = p[c][2 * y];
      im[c] = p[c][2 * y + 1];
      out_re[c] = own[c][y] * re[c];
      out_im[c] = own[c][y] * im[c];
    }
    int k = 0;
    for (int c = 0; c < channels; ++c) {
      for (int d = c + 1; d < channels; ++d, ++k) {
        const double g_re = between[k][2 * y];
        const double g_im = between[k][2 * y + 1];
        out_re[c] += g_re * re[d] - g_im * im[d];
        out_im[c] += g_re * im[d] + g_im * re[d];
        out_re[d] += g_re * re[c] + g_im * im[c];
        out_im[d] += g_re * im[c] - g_im * re[c];
      }
    }
    for (int c = 0; c < channels; ++c) {
      p[c][2 * y] = out_re[c];
      p[c][2 * y + 1] = out_im[c];
    }
  }
}

using Multiply = void (*)(const SpectrumColumns&, int, std::size_t, std::span<const std::vector<double>>,
                          std::span<const Bins>);
constexpr Multiply multiply_by_channels[] = {multiply<1>, multiply<2>, multiply<3>, multiply<4>,
                                             multiply<5>, multiply<6>, multiply<7>, multiply<8>};

}  // namespace

void BoxCovariance::apply(Planes& fields, Workspace& workspace) const {
  const Multiply multiply_bins = multiply_by_channels[channels_ - 1];
  transform_.map(
      fields,
      [&](const SpectrumColumns& block) {
        for_columns(block, transform_.columns(),
                    [&](int i, std::size_t n) { multiply_bins(block, i, n, diagonal_, off_diagonal_); });
      },
      workspace);
}

Planes BoxCovariance::lags(int c, int d, Workspace& workspace) const {
  const BoxTransform whole(grid(), grid());
  Planes result(grid(), 1);
  std::size_t pair = 0;
  for (int first = 0; first < c; ++first) pair += static_cast<std::size_t>(channels_ - 1 - first);
  pair += static_cast<std::size_t>(d - c - 1);
  whole.inverse(
      [&](const SpectrumColumns& block) {
        for_columns(block, whole.columns(), [&](int i, std::size_t n) {
          std::complex<double>* out = block.column(0, i);
          for (int y = 0; y < block.height; ++y) {
            out[y] = c == d ? std::complex<double>(diagonal_[static_cast<std::size_t>(c)][n + y])
                            : off_diagonal_[pair][n + y];
          }
        });
      },
      result, workspace);
  return result;
}

CovarianceTable BoxCovariance::table(Extent reach) const {
  if (reach.width > box().width || reach.height > box().height) {
    throw std::invalid_argument(fmt::format("lags of {}x{} of a box of {}x{}: expected no more", reach.width,
                                            reach.height, box().width, box().height));
  }
  CovarianceTable result(reach, channels_);
  Workspace workspace;
  for (int c = 0; c < channels_; ++c) {
    for (int d = c; d < channels_; ++d) {
      const Planes values = lags(c, d, workspace);
      for (int vy = 1 - reach.height; vy < reach.height; ++vy) {
        const double* row = values.row(0, (vy + grid().height) % grid().height);
        for (int vx = 1 - reach.width; vx < reach.width; ++vx) {
          const double value = row[(vx + grid().width) % grid().width];
          result.at(c, d, vx, vy) = value;
          result.at(d, c, -vx, -vy) = value;
        }
      }
    }
  }
  return result;
}

}  // namespace textonbench
