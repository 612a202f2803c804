// The explicit list of methods.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "methods/conditional/inpainting.h"
#include "methods/method.h"
#include "methods/sparse/gabor.h"
#include "methods/sparse/lrp.h"
#include "methods/spectral/adsn.h"
#include "methods/spectral/rpn.h"
#include "methods/spot/canonical_texton.h"
#include "methods/spot/dsn.h"
#include "methods/spot/filtered_noise.h"
#include "methods/spot/luminance_texton.h"
#include "methods/spot/mixing.h"
#include "methods/spot/optimal_texton.h"
#include "methods/spot/sot.h"
#include "methods/spot/surface_noise.h"
#include "methods/spot/texton_noise.h"

namespace textonbench {

std::span<const MethodEntry> method_catalog() {
  static const std::vector<MethodEntry> entries = {rpn_entry(),
                                                   adsn_entry(),
                                                   dsn_entry(),
                                                   canonical_texton_entry(),
                                                   luminance_texton_entry(),
                                                   sot_entry(),
                                                   optimal_texton_entry(),
                                                   texton_noise_entry(),
                                                   surface_noise_entry(),
                                                   filtered_noise_entry(),
                                                   mixing_entry(),
                                                   inpainting_entry(),
                                                   lrp_entry(),
                                                   gabor_entry(),
                                                   gabor_by_example_entry()};
  return entries;
}

const MethodEntry& find_method(std::string_view name) {
  const auto catalog = method_catalog();
  const auto found = std::ranges::find(catalog, name, &MethodEntry::name);
  if (found != catalog.end()) {
    return *found;
  }
  std::vector<std::string_view> names;
  std::ranges::transform(catalog, std::back_inserter(names), &MethodEntry::name);
  throw std::invalid_argument(
      fmt::format("unknown method \"{}\"{}; \"textonbench list methods\" shows all", name, did_you_mean(name, names)));
}

}  // namespace textonbench
