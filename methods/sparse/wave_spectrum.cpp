#include "methods/sparse/wave_spectrum.h"

#include <cmath>

#include "methods/base/parallel.h"

namespace textonbench {
namespace {

constexpr int nodes_a_spacing = 32;
/// Nodes of the correlation along an axis, from −3 to 3 spacings.
constexpr int correlation_nodes = 6 * nodes_a_spacing + 1;

std::size_t node_index(int x, int y) {
  return static_cast<std::size_t>(y) * correlation_nodes + static_cast<std::size_t>(x);
}

/// The window of the lattice point 0 at (x, y) spacings from it, with its scale.
double scaled_window(LrpWindow window, bool even_variance, double x, double y) {
  const double own = lrp_window(window, std::hypot(x, y));
  if (!even_variance || own == 0) return own;
  const double left = std::round(x), top = std::round(y);
  double squares = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      squares += std::pow(lrp_window(window, std::hypot(x - left - dx, y - top - dy)), 2);
    }
  }
  return own / std::sqrt(squares);
}

/// Catmull and Rom's cubic through nodes −1, 0, 1 and 2, at t in [0, 1].
double cubic(const double (&p)[4], double t) {
  return p[1] +
         0.5 * t * (p[2] - p[0] + t * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] + t * (3 * (p[1] - p[2]) + p[3] - p[0])));
}

/// Planes of C x C covariances or spectra: entry (c, d), d <= c.
std::size_t pair_index(int c, int d) {
  const auto row = static_cast<std::size_t>(c);
  return row * (row + 1) / 2 + static_cast<std::size_t>(d);
}

std::size_t pair_count(int channels) { return pair_index(channels, 0); }

/// Σ_j mean over its bins and colors of ½ Re(a_c conj(a_d) exp(2πi k·v / T)), at the lags v of the torus.
std::vector<Image> bin_covariance(const WaveField& field, const WaveLayer& layer) {
  const int side = 1 << field.side_bits;
  std::vector<Spectrum> sums;
  for (std::size_t pair = 0; pair < pair_count(field.channels); ++pair) sums.emplace_back(Extent{side, side}, 1);
  const auto colors = static_cast<std::size_t>(layer.colors);
  const auto channels = static_cast<std::size_t>(field.channels);
  // inverse_fft() divides by the number of bins, and a bin and its mirror image share a wave.
  const double scale = 0.25 * side * side;
  const auto wrap = [side](int k) { return (k % side + side) % side; };
  for (int j = 0; j < layer.waves(); ++j) {
    const std::uint32_t first = layer.first[static_cast<std::size_t>(j)],
                        end = layer.first[static_cast<std::size_t>(j) + 1];
    for (std::size_t bin = first; bin < end; ++bin) {
      const auto [kx, ky] = layer.bins[bin];
      double before = 0;
      for (std::size_t v = 0; v < colors; ++v) {
        const std::size_t entry = bin * colors + v;
        const double until = v + 1 == colors ? 1 : layer.chance[entry] * 0x1p-32;
        const double weight = scale * (until - before) / (end - first);
        before = until;
        const std::complex<float>* a = layer.color.data() + entry * channels;
        for (int c = 0; c < field.channels; ++c) {
          for (int d = 0; d <= c; ++d) {
            const std::complex<double> h = weight * std::complex<double>(a[c]) * std::conj(std::complex<double>(a[d]));
            const auto add = [&](int x, int y, std::complex<double> value) {
              if (2 * wrap(x) > side) return;
              sums[pair_index(c, d)].at(0, wrap(x), wrap(y)) += std::complex<float>(value);
            };
            add(kx, ky, h);
            add(-kx, -ky, std::conj(h));
          }
        }
      }
    }
  }
  std::vector<Image> covariance;
  covariance.reserve(sums.size());
  for (const Spectrum& sum : sums) covariance.push_back(inverse_fft(sum));
  return covariance;
}

}  // namespace

WindowCorrelation::WindowCorrelation(LrpWindow window, bool even_variance)
    : nodes_(static_cast<std::size_t>(correlation_nodes) * correlation_nodes) {
  constexpr int half = 3 * nodes_a_spacing / 2;  // the window's reach in nodes
  constexpr int side = 256;                      // above twice the window's nodes
  Image nodes({side, side}, 1);
  for (int y = -half; y <= half; ++y) {
    for (int x = -half; x <= half; ++x) {
      nodes.at(0, x + half, y + half) = static_cast<float>(scaled_window(
          window, even_variance, static_cast<double>(x) / nodes_a_spacing, static_cast<double>(y) / nodes_a_spacing));
    }
  }
  Spectrum power = forward_fft(nodes);
  for (int ky = 0; ky < side; ++ky) {
    for (std::complex<float>& bin : power.row(0, ky)) bin = std::norm(bin);
  }
  const Image correlation = inverse_fft(power);
  constexpr int reach = 3 * nodes_a_spacing;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      nodes_[node_index(x + reach, y + reach)] =
          static_cast<double>(correlation.at(0, (x + side) % side, (y + side) % side)) /
          (nodes_a_spacing * nodes_a_spacing);
    }
  }
}

double WindowCorrelation::node(int x, int y) const {
  if (x < 0 || y < 0 || x >= correlation_nodes || y >= correlation_nodes) return 0;
  return nodes_[node_index(x, y)];
}

double WindowCorrelation::at(double x, double y) const {
  if (std::abs(x) >= 3 || std::abs(y) >= 3) return 0;
  const double u = (x + 3) * nodes_a_spacing, v = (y + 3) * nodes_a_spacing;
  const auto left = static_cast<int>(std::floor(u)), top = static_cast<int>(std::floor(v));
  double rows[4];
  for (int i = 0; i < 4; ++i) {
    const int row = top - 1 + i;
    rows[i] = cubic({node(left - 1, row), node(left, row), node(left + 1, row), node(left + 2, row)}, u - left);
  }
  return cubic(rows, v - top);
}

CrossSpectrum wave_spectrum(const WaveField& field, Extent grid) {
  const WindowCorrelation correlation(field.window, field.even_variance);
  const int channels = field.channels;
  const int side = 1 << field.side_bits;
  std::vector<Image> covariance;
  for (std::size_t pair = 0; pair < pair_count(channels); ++pair) covariance.emplace_back(grid, 1);
  const auto wrap = [](int i, int n) { return (i % n + n) % n; };
  for (const WaveLayer& layer : field.layers) {
    const std::vector<Image> bins = bin_covariance(field, layer);
    const int reach = static_cast<int>(std::ceil(3 * layer.pixels()));
    // Lags that fall on one row of the grid are summed by one thread.
    parallel_for(grid.height, [&](int row) {
      const int first = -reach + wrap(row + reach, grid.height);
      for (int vy = first; vy <= reach; vy += grid.height) {
        for (int vx = -reach; vx <= reach; ++vx) {
          const double w = correlation.at(vx / layer.pixels(), vy / layer.pixels());
          if (w == 0) continue;
          for (std::size_t pair = 0; pair < bins.size(); ++pair) {
            covariance[pair].at(0, wrap(vx, grid.width), row) +=
                static_cast<float>(w * static_cast<double>(bins[pair].at(0, wrap(vx, side), wrap(vy, side))));
          }
        }
      }
    });
  }
  std::vector<Spectrum> p;
  p.reserve(covariance.size());
  for (const Image& plane : covariance) p.push_back(forward_fft(plane));
  return factor_products(p, channels);
}

}  // namespace textonbench
