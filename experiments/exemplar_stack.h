// Exemplars that are stacks of maps: several pictures of one surface, modeled together.
#pragma once

#include <string>
#include <vector>

#include "experiments/exemplars.h"

namespace textonbench {

/// The stack of the exemplars or files that stand between the signs "+", named by their names joined by "+". Throws
/// std::invalid_argument for nothing beside a "+", and as find_exemplar.
ExemplarInfo find_stack(const ExemplarCatalog& catalog, const std::string& names);

/// The maps of `info` in order. A file that is a stack itself gives its own maps. Throws std::invalid_argument naming
/// both files when sizes differ, the name of two maps of one name, and the number when there are more than 8 channels.
Exemplar load_stack(const ExemplarInfo& info, std::vector<std::string>* notes, const ReadOptions& options = {});

}  // namespace textonbench
