#include "methods/spectral/rpn.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "methods/spectral/hermitian_noise.h"

namespace textonbench {
namespace {

class Rpn final : public Model, public Gaussian {
 public:
  explicit Rpn(GaussianModel model) : model_(std::move(model)) {}

  Image synthesize(const Domain& domain, Seed seed) const override {
    if (const auto reason = refuse_other_torus("rpn", size(), domain)) {
      throw std::invalid_argument(*reason);
    }
    return modulate(model_, Stream(seed).child("rpn"), HermitianNoise::phase);
  }

  const Gaussian* gaussian() const override { return this; }
  std::vector<double> mean() const override { return model_.mean; }
  CrossSpectrum spectrum(Extent grid) const override {
    if (grid != size()) {
      throw std::invalid_argument(fmt::format("the spectrum of rpn exists on its torus {}x{} only, not on {}x{}",
                                              size().width, size().height, grid.width, grid.height));
    }
    return model_.spectrum;
  }

  Footprint footprint(const Domain&) const override {
    return {model_.spectrum.factors.front().bytes(), spectral_operations(model_.spectrum.channels(), size())};
  }

 private:
  Extent size() const { return model_.spectrum.grid(); }
  GaussianModel model_;
};

std::span<const ParamSpec> rpn_params() {
  static const std::vector<ParamSpec> specs = {
      component_param(),
      {.name = "phase",
       .default_value = std::string("added"),
       .unit = "",
       .help = "added: the random phase is added to the exemplar's; replaced: it takes its place in every channel "
               "(false colors, on purpose)",
       .choices = {"added", "replaced"}},
  };
  return specs;
}

}  // namespace

std::unique_ptr<Model> fit_rpn(const Exemplar& exemplar, const RpnOptions& options) {
  GaussianModel model = fit_spot(exemplar, options.component);
  if (options.phase == PhaseRule::replaced) {
    Spectrum& spot = model.spectrum.factors.front();
    for (int c = 0; c < spot.channels(); ++c) {
      for (int ky = 0; ky < spot.rows(); ++ky) {
        for (std::complex<float>& bin : spot.row(c, ky)) {
          bin = std::abs(bin);
        }
      }
    }
  }
  return std::make_unique<Rpn>(std::move(model));
}

MethodEntry rpn_entry() {
  return {.name = "rpn",
          .title = "Random phase noise",
          .reference = "Lectures 2022, Random phase noise; van Wijk 1991",
          .params = rpn_params(),
          .refuses =
              [](const Problem& problem, const Params&, const Domain& domain) {
                return refuse_other_torus("rpn", problem.exemplar.pixels.extent(), domain);
              },
          .analyze =
              [](const Problem& problem, const Params& params, Seed) {
                return fit_rpn(problem.exemplar,
                               {.component = component_of(params),
                                .phase = params.text("phase") == "added" ? PhaseRule::added : PhaseRule::replaced});
              }};
}

}  // namespace textonbench
