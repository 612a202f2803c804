#include "methods/spectral/adsn.h"

#include <cmath>
#include <stdexcept>

#include "methods/base/parallel.h"
#include "methods/spectral/hermitian_noise.h"

namespace textonbench {
namespace {

/// White noise of the plane at whole coordinates: row y, number x. Moved by 2^63 so that a row's numbers are
/// consecutive across x = 0.
void fill_plane_noise(const Stream& stream, std::int64_t x, std::int64_t y, std::span<float> out) {
  fill_normal(stream, static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(x) + (std::uint64_t{1} << 63U), out);
}

class Adsn final : public Model, public Gaussian {
 public:
  explicit Adsn(GaussianModel model) : model_(std::move(model)) {}

  Image synthesize(const Domain& domain, Seed seed) const override {
    if (const auto reason = refuse(size(), domain)) {
      throw std::invalid_argument(*reason);
    }
    const Stream stream = Stream(seed).child("adsn");
    return domain.periodic ? modulate(model_, stream.child("torus"), HermitianNoise::gaussian)
                           : window_of_plane(domain, stream.child("plane"));
  }

  static std::optional<std::string> refuse(Extent exemplar, const Domain& domain) {
    return domain.periodic ? refuse_other_torus("adsn", exemplar, domain) : refuse_off_grid("adsn", domain);
  }

  const Gaussian* gaussian() const override { return this; }
  std::vector<double> mean() const override { return model_.mean; }

  CrossSpectrum spectrum(Extent grid) const override {
    if (grid == size()) {
      return model_.spectrum;
    }
    // The spot wrapped around the grid has the plane's spectrum at the grid's frequencies.
    const Image spot = inverse_fft(model_.spectrum.factors.front());
    Image wrapped(grid, spot.channels());
    for (int c = 0; c < spot.channels(); ++c) {
      for (int y = 0; y < spot.height(); ++y) {
        for (int x = 0; x < spot.width(); ++x) {
          wrapped.at(c, x % grid.width, y % grid.height) += spot.at(c, x, y);
        }
      }
    }
    CrossSpectrum result;
    result.factors.push_back(forward_fft(wrapped));
    return result;
  }

  Footprint footprint(const Domain& domain) const override {
    const int channels = model_.spectrum.channels();
    const std::size_t bytes = model_.spectrum.factors.front().bytes();
    if (domain.periodic) {
      return {bytes, spectral_operations(channels, size())};
    }
    // One transform of the noise, one of the padded spot and one back for each channel.
    const Extent padded = padded_size(domain);
    const double transforms = (2 * channels + 1) * 2.5 * std::log2(static_cast<double>(padded.area())) + 3 * channels;
    return {bytes, transforms * static_cast<double>(padded.area()) / static_cast<double>(domain.size.area())};
  }

 private:
  Extent size() const { return model_.spectrum.grid(); }

  Extent padded_size(const Domain& domain) const {
    return {good_fft_size(domain.size.width + size().width - 1), good_fft_size(domain.size.height + size().height - 1)};
  }

  Image window_of_plane(const Domain& domain, const Stream& stream) const {
    const Image spot = inverse_fft(model_.spectrum.factors.front());
    const int left = spot.width() - 1;
    const int top = spot.height() - 1;
    const Extent padded = padded_size(domain);

    // Pixel x of the window needs the noise at x − spot.width() + 1 … x.
    Image noise(padded, 1);
    const auto x0 = static_cast<std::int64_t>(domain.origin.x) - left;
    const auto y0 = static_cast<std::int64_t>(domain.origin.y) - top;
    parallel_for(domain.size.height + top, [&](int y) {
      fill_plane_noise(
          stream, x0, y0 + y,
          noise.row(0, y).first(static_cast<std::size_t>(domain.size.width) + static_cast<std::size_t>(left)));
    });
    const Spectrum noise_spectrum = forward_fft(noise);

    Image padded_spot(padded, spot.channels());
    for (int c = 0; c < spot.channels(); ++c) {
      for (int y = 0; y < spot.height(); ++y) {
        const auto row = spot.row(c, y);
        std::copy(row.begin(), row.end(), padded_spot.row(c, y).begin());
      }
    }
    Spectrum product = forward_fft(padded_spot);
    for (int c = 0; c < spot.channels(); ++c) {
      parallel_for(product.rows(), [&](int ky) {
        const auto w = noise_spectrum.row(0, ky);
        const auto p = product.row(c, ky);
        for (std::size_t kx = 0; kx < p.size(); ++kx) {
          p[kx] = {p[kx].real() * w[kx].real() - p[kx].imag() * w[kx].imag(),
                   p[kx].real() * w[kx].imag() + p[kx].imag() * w[kx].real()};
        }
      });
    }
    Image sample = crop(inverse_fft(product), left, top, domain.size);
    for (int c = 0; c < sample.channels(); ++c) {
      const auto mean = static_cast<float>(model_.mean[static_cast<std::size_t>(c)]);
      for (int y = 0; y < sample.height(); ++y) {
        for (float& v : sample.row(c, y)) {
          v += mean;
        }
      }
    }
    return sample;
  }

  GaussianModel model_;
};

std::span<const ParamSpec> adsn_params() {
  static const std::vector<ParamSpec> specs = {component_param()};
  return specs;
}

}  // namespace

std::unique_ptr<Model> fit_adsn(const Exemplar& exemplar, const AdsnOptions& options) {
  return std::make_unique<Adsn>(fit_spot(exemplar, options.component));
}

MethodEntry adsn_entry() {
  return {.name = "adsn",
          .title = "Asymptotic discrete spot noise",
          .reference = "Lectures 2022, Asymptotic discrete spot noise; Galerne, Gousseau, Morel 2011",
          .params = adsn_params(),
          .refuses = [](const Problem& problem, const Params&,
                        const Domain& domain) { return Adsn::refuse(problem.exemplar.pixels.extent(), domain); },
          .analyze = [](const Problem& problem, const Params& params,
                        Seed) { return fit_adsn(problem.exemplar, {.component = component_of(params)}); }};
}

}  // namespace textonbench
