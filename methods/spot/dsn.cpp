#include "methods/spot/dsn.h"

namespace textonbench {
namespace {

std::span<const ParamSpec> dsn_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = spot_noise_params("poisson");
    all.push_back(component_param());
    return all;
  }();
  return specs;
}

}  // namespace

Texton exemplar_spot_texton(const Exemplar& exemplar, SpotSource source) {
  GaussianModel model = fit_spot(exemplar, source);
  Texton texton;
  texton.kernels.push_back(inverse_fft(model.spectrum.factors.front()));
  texton.support_pixels = texton.extent().area();
  texton.mean = std::move(model.mean);
  return texton;
}

MethodEntry dsn_entry() {
  return {.name = "dsn",
          .title = "Discrete spot noise",
          .reference = "EUSIPCO 2014, Algorithm 1; van Wijk 1991",
          .params = dsn_params(),
          .refuses = [](const Problem& problem, const Params&,
                        const Domain& domain) { return refuse_spot_noise(problem.exemplar.pixels.extent(), domain); },
          .analyze =
              [](const Problem& problem, const Params& params, Seed) {
                Texton texton = exemplar_spot_texton(problem.exemplar, component_of(params));
                const SpotNoiseOptions options = spot_noise_options(params, texton.support_pixels);
                return make_spot_noise(std::move(texton), options);
              }};
}

}  // namespace textonbench
