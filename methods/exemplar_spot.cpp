#include "methods/exemplar_spot.h"

#include <fmt/format.h>

#include <cmath>

#include "methods/base/spectrum.h"

namespace textonbench {

ParamSpec component_param() {
  return {.name = "component",
          .default_value = std::string("periodic"),
          .unit = "",
          .help = "periodic: take the spot from the exemplar's periodic component; raw: from the exemplar as it is",
          .choices = {"periodic", "raw"}};
}

SpotSource component_of(const Params& params) {
  return params.text("component") == "periodic" ? SpotSource::periodic_component : SpotSource::raw;
}

GaussianModel fit_spot(const Exemplar& exemplar, SpotSource source) {
  require_usable(exemplar);
  return source == SpotSource::raw ? gaussian_model(exemplar.pixels)
                                   : gaussian_model(periodic_component(exemplar.pixels));
}

std::optional<std::string> refuse_off_grid(std::string_view method, const Domain& domain) {
  if (domain.step != 1 || domain.origin.x != std::floor(domain.origin.x) ||
      domain.origin.y != std::floor(domain.origin.y)) {
    return fmt::format(
        "{} is defined on the pixel grid: step {} from ({}, {}) asked for, expected step 1 from whole "
        "coordinates",
        method, domain.step, domain.origin.x, domain.origin.y);
  }
  // Coordinates are exact in double precision, and windows of one sample agree, up to here.
  constexpr double farthest = 0x1p52;
  if (!(std::fabs(domain.origin.x) < farthest && std::fabs(domain.origin.y) < farthest)) {
    return fmt::format("{}: origin ({}, {}) is out of range, expected less than 2^52 in size", method, domain.origin.x,
                       domain.origin.y);
  }
  return std::nullopt;
}

std::optional<std::string> refuse_other_torus(std::string_view method, Extent exemplar, const Domain& domain) {
  if (!domain.periodic) {
    return fmt::format(
        "{} makes torus images of the exemplar's own size ({}x{}) only; a window of another field needs "
        "a method of the plane, such as adsn",
        method, exemplar.width, exemplar.height);
  }
  if (domain.size != exemplar) {
    return fmt::format(
        "{} on a torus needs the exemplar's own size {}x{}, but {}x{} was asked for; adsn on a domain "
        "that is not periodic takes any size",
        method, exemplar.width, exemplar.height, domain.size.width, domain.size.height);
  }
  if (domain.origin != Point2{}) {
    return fmt::format("{} on a torus starts at (0, 0), but ({}, {}) was asked for", method, domain.origin.x,
                       domain.origin.y);
  }
  return refuse_off_grid(method, domain);
}

double spectral_operations(int channels, Extent raster) {
  return channels * (2.5 * std::log2(static_cast<double>(raster.area())) + 3);
}

}  // namespace textonbench
