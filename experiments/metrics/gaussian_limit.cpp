#include "experiments/metrics/gaussian_limit.h"

#include "methods/spot/spot_noise.h"

namespace textonbench {

std::unique_ptr<Model> gaussian_limit(const Model& model) {
  return model.texton() == nullptr ? nullptr : make_spot_noise(*model.texton(), {.impacts = Impacts::gaussian});
}

}  // namespace textonbench
