#include "methods/spot/dsn.h"

#include "methods/spot/extended_spot.h"

namespace textonbench {
namespace {

std::span<const ParamSpec> dsn_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = spot_noise_params("poisson");
    all.push_back(component_param());
    all.push_back(
        {.name = "border",
         .default_value = std::int64_t{0},
         .unit = "pixel",
         .help = "the spot rises from zero over so many pixels at its border, and is scaled to keep its variance: "
                 "the equivalent spot, for windows larger than the exemplar; 0: the spot as it is",
         .min = 0,
         .max = 1 << 20});
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
                if (const auto border = static_cast<int>(params.integer("border")); border > 0) {
                  texton.kernels.front() = equivalent_spot(texton.kernels.front(), texton.extent(), border);
                }
                const SpotNoiseOptions options = spot_noise_options(params, texton.support_pixels);
                return make_spot_noise(std::move(texton), options);
              }};
}

}  // namespace textonbench
