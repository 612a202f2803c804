#include "methods/spot/luminance_texton.h"

#include <fmt/format.h>

#include <stdexcept>

#include "methods/spot/spot_noise.h"
#include "methods/spot/zero_phase_texton.h"

namespace textonbench {
namespace {

ParamSpec weight_param(std::string_view name, double weight) {
  return {.name = name,
          .default_value = weight,
          .unit = "",
          .help = "weight of the channel in the luminance whose phase is taken off"};
}

std::optional<std::string> refuse_stack(const Exemplar& exemplar) {
  const int channels = exemplar.pixels.channels();
  if (channels == 1 || channels == 3) {
    return std::nullopt;
  }
  return fmt::format(
      "luminance_texton is defined for gray and color exemplars, by their luminance: \"{}\" has {} channels; sot "
      "serves stacks of maps",
      exemplar.name, channels);
}

std::span<const ParamSpec> luminance_texton_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = support_params(0);
    const LuminanceWeights weights;
    all.push_back(weight_param("weight_red", weights.red));
    all.push_back(weight_param("weight_green", weights.green));
    all.push_back(weight_param("weight_blue", weights.blue));
    all.push_back(component_param());
    const std::vector<ParamSpec> noise = spot_noise_params("gaussian");
    all.insert(all.end(), noise.begin(), noise.end());
    return all;
  }();
  return specs;
}

}  // namespace

Texton luminance_texton(const Exemplar& exemplar, SpotSource component, const LuminanceWeights& weights,
                        const Support& support) {
  if (const auto reason = refuse_stack(exemplar)) {
    throw std::invalid_argument(*reason);
  }
  const GaussianModel model = fit_spot(exemplar, component);
  return exemplar.pixels.channels() == 1
             ? zero_phase_texton(model, std::array{1.0}, support)
             : zero_phase_texton(model, std::array{weights.red, weights.green, weights.blue}, support);
}

MethodEntry luminance_texton_entry() {
  return {.name = "luminance_texton",
          .title = "Luminance texton",
          .reference = "EUSIPCO 2014, section 4; Desolneux, Moisan, Ronsin 2012",
          .params = luminance_texton_params(),
          .refuses =
              [](const Problem& problem, const Params& params, const Domain& domain) {
                const auto stack = refuse_stack(problem.exemplar);
                return stack ? stack
                             : refuse_spot_noise(support_of(params, problem.exemplar.pixels.extent()).box, domain);
              },
          .analyze =
              [](const Problem& problem, const Params& params, Seed) {
                require_usable(problem.exemplar);
                const Support support = support_of(params, problem.exemplar.pixels.extent());
                const LuminanceWeights weights{.red = params.number("weight_red"),
                                               .green = params.number("weight_green"),
                                               .blue = params.number("weight_blue")};
                return make_spot_noise(luminance_texton(problem.exemplar, component_of(params), weights, support),
                                       spot_noise_options(params, support.pixels));
              }};
}

}  // namespace textonbench
