#include "methods/spectral/adsn.h"

#include <cmath>
#include <stdexcept>

#include "methods/base/convolution.h"
#include "methods/base/parallel.h"
#include "methods/spectral/hermitian_noise.h"

namespace textonbench {
namespace {

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
    CrossSpectrum result;
    result.factors.push_back(forward_fft(wrap(inverse_fft(model_.spectrum.factors.front()), grid)));
    return result;
  }

  Footprint footprint(const Domain& domain) const override {
    const int channels = model_.spectrum.channels();
    const std::size_t bytes = model_.spectrum.factors.front().bytes();
    if (domain.periodic) {
      return {bytes, spectral_operations(channels, size())};
    }
    // One transform of the noise, one of the padded spot and one back for each channel.
    const Extent padded = convolution_grid(size(), domain.size);
    const double transforms = (2 * channels + 1) * 2.5 * std::log2(static_cast<double>(padded.area())) + 3 * channels;
    return {bytes, transforms * static_cast<double>(padded.area()) / static_cast<double>(domain.size.area())};
  }

 private:
  Extent size() const { return model_.spectrum.grid(); }

  Image window_of_plane(const Domain& domain, const Stream& stream) const {
    const Image spot = inverse_fft(model_.spectrum.factors.front());
    // Pixel x of the window needs the noise at x − spot.width() + 1 … x.
    Image noise({domain.size.width + spot.width() - 1, domain.size.height + spot.height() - 1}, 1);
    const auto x0 = static_cast<std::int64_t>(domain.origin.x) - (spot.width() - 1);
    const auto y0 = static_cast<std::int64_t>(domain.origin.y) - (spot.height() - 1);
    parallel_for(noise.height(), [&](int y) { fill_plane_normal(stream, x0, y0 + y, noise.row(0, y)); });
    Image sample = convolve_valid({&spot, 1}, {&noise, 1});
    add_constant(model_.mean, sample);
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
