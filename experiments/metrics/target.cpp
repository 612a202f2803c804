#include <utility>

#include "experiments/metrics/metric.h"
#include "methods/base/spectrum.h"

namespace textonbench {

Target make_target(const Exemplar& exemplar) {
  require_usable(exemplar);
  Image periodic = periodic_component(exemplar.pixels);
  GaussianModel gaussian = gaussian_model(periodic);
  Autocovariance covariance = autocovariance(gaussian.spectrum);
  return {exemplar, std::move(periodic), std::move(gaussian), std::move(covariance)};
}

}  // namespace textonbench
