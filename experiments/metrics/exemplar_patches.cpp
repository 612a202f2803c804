#include "experiments/metrics/exemplar_patches.h"

#include "experiments/metrics/patch_distance.h"
#include "methods/base/spectrum.h"

namespace textonbench {

std::optional<double> exemplar_patch_distance(const Model&, const Target& target, const Domain&) {
  const Extent extent = target.exemplar.pixels.extent();
  if (extent.width < 3 || extent.height < 3) return std::nullopt;
  const Domain torus{.size = extent, .periodic = true};
  const std::vector<Image> exemplar{periodic_component(target.exemplar.pixels)};
  return measure_samples(*patch_distance(target, torus, Seed{1}), exemplar, torus).value;
}

}  // namespace textonbench
