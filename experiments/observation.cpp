#include "experiments/observation.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "methods/base/masks.h"

namespace textonbench {

std::optional<Observation> observation(const MethodEntry& method, const std::map<std::string, ParamValue>& params,
                                       Extent exemplar) {
  const auto option = std::ranges::find(method.params, "mask", &ParamSpec::unit);
  if (option == method.params.end()) return std::nullopt;
  const Params complete(method.params, params);
  const bool has_share = std::ranges::find(method.params, "missing", &ParamSpec::name) != method.params.end();
  const double percent = has_share ? complete.number("missing") : 10;
  try {
    return Observation{make_mask(complete.text(option->name), percent, exemplar)};
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("option {}: {}", option->name, error.what()));
  }
}

}  // namespace textonbench
