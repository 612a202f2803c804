// The file configs/exemplars.toml: tables [[package]] and [[exemplar]].
//
// An [[exemplar]] has name, package, file (of a package with a folder), sha256 and tags. A stack of maps has instead of
// file a list of at least two files, for every package: maps are named by their files without extension, and a map is
// a file of that name in the package's folder or the user's. Its sha256 is a list as long.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/exemplars.h"

namespace textonbench {

/// What the file says of one exemplar, before anybody looked whether it is here.
struct CatalogRow {
  ExemplarInfo info;
  std::filesystem::path installed;    ///< where its package puts it; empty when only a user's folder can have it
  std::vector<CatalogRow> maps = {};  ///< of a stack
};

/// In file order. Throws ConfigError.
std::vector<CatalogRow> read_exemplar_catalog(const std::filesystem::path& file);

}  // namespace textonbench
