// What a method is told of an exemplar that is not known everywhere.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "methods/method.h"

namespace textonbench {

/// The observation that the option of unit "mask" describes (methods/base/masks.h), of `missing` percent where
/// the method has that option; nothing for a method without such an option. Throws std::invalid_argument with the
/// option.
std::optional<Observation> observation(const MethodEntry& method, const std::map<std::string, ParamValue>& params,
                                       Extent exemplar);

}  // namespace textonbench
