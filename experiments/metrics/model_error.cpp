#include "experiments/metrics/model_error.h"

#include <cmath>

namespace textonbench {
namespace {

template <class Error>
std::optional<double> compare(const Model& model, const Target& target, const Error& error) {
  const Gaussian* gaussian = model.gaussian();
  if (gaussian == nullptr) return std::nullopt;
  const CrossSpectrum& wanted = target.gaussian.spectrum;
  return error(gaussian->spectrum(wanted.grid()), wanted);
}

}  // namespace

std::optional<double> rme(const Model& model, const Target& target, const Domain&) {
  return compare(model, target, relative_model_error);
}

std::optional<double> rme_printed(const Model& model, const Target& target, const Domain&) {
  return compare(model, target, relative_model_error_as_printed);
}

std::optional<double> ot_distance(const Model& model, const Target& target, const Domain&) {
  return compare(model, target, [](const CrossSpectrum& p, const CrossSpectrum& q) {
    return std::sqrt(transport_distance_squared(p, q));
  });
}

}  // namespace textonbench
