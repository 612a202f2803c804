// The file configs/exemplars.toml: tables [[package]] and [[exemplar]].
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/exemplars.h"

namespace textonbench {

/// What the file says of one exemplar, before anybody looked whether it is here.
struct CatalogRow {
  ExemplarInfo info;
  std::filesystem::path installed;  ///< where its package puts it; empty when only a user's folder can have it
};

/// In file order. Throws ConfigError.
std::vector<CatalogRow> read_exemplar_catalog(const std::filesystem::path& file);

}  // namespace textonbench
