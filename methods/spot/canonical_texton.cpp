#include "methods/spot/canonical_texton.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "methods/spot/spot_noise.h"
#include "methods/spot/zero_phase_texton.h"

namespace textonbench {
namespace {

std::optional<std::string> refuse_color(const Exemplar& exemplar) {
  if (exemplar.pixels.channels() == 1) {
    return std::nullopt;
  }
  return fmt::format("canonical_texton is defined for gray exemplars: \"{}\" has {} channels; {}", exemplar.name,
                     exemplar.pixels.channels(),
                     exemplar.pixels.channels() == 3 ? "luminance_texton serves color" : "sot serves stacks of maps");
}

std::span<const ParamSpec> canonical_texton_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = support_params(0);
    all.push_back(component_param());
    const std::vector<ParamSpec> noise = spot_noise_params("gaussian");
    all.insert(all.end(), noise.begin(), noise.end());
    return all;
  }();
  return specs;
}

}  // namespace

Texton canonical_texton(const Exemplar& exemplar, SpotSource component, const Support& support) {
  require_usable(exemplar);
  if (const auto reason = refuse_color(exemplar)) {
    throw std::invalid_argument(*reason);
  }
  return zero_phase_texton(fit_spot(exemplar, component), std::array{1.0}, support);
}

MethodEntry canonical_texton_entry() {
  return {.name = "canonical_texton",
          .title = "Canonical texton",
          .reference = "Lectures 2022, Texton; Desolneux, Moisan, Ronsin 2012",
          .params = canonical_texton_params(),
          .refuses =
              [](const Problem& problem, const Params& params, const Domain& domain) {
                const auto color = refuse_color(problem.exemplar);
                return color ? color
                             : refuse_spot_noise(support_of(params, problem.exemplar.pixels.extent()).box, domain);
              },
          .analyze =
              [](const Problem& problem, const Params& params, Seed) {
                require_usable(problem.exemplar);
                const Support support = support_of(params, problem.exemplar.pixels.extent());
                return make_spot_noise(canonical_texton(problem.exemplar, component_of(params), support),
                                       spot_noise_options(params, support.pixels));
              }};
}

}  // namespace textonbench
