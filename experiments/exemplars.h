// Which exemplars there are and where a reader gets them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "methods/base/exemplar.h"
#include "methods/base/image_io.h"

namespace textonbench {

/// What `textonbench list exemplars` tells of one.
struct ExemplarInfo {
  std::string name;
  bool available = false;
  /// Empty for a procedural exemplar, for a stack of maps and for one that was not found. Of one that is not available:
  /// a file in TEXTONBENCH_DATA that has its name, or that of one of its maps, and is something else.
  std::filesystem::path file;
  std::string source;  ///< "Debian mypaint-data-extras", "procedural, seed 1", "TEXTONBENCH_DATA", …
  std::string licence;
  std::string how_to_get;               ///< for one that is not here
  std::string expected_sha256;          ///< empty when any file of that name will do
  std::vector<std::string> tags;        ///< "default", "micro", "structured", "procedural", "paper", "stack"
  std::vector<ExemplarInfo> maps = {};  ///< of a stack that several pictures make, in order
};

class ExemplarCatalog {
 public:
  /// Reads configs/exemplars.toml below `home` and the folder TEXTONBENCH_DATA. Throws std::invalid_argument with
  /// file:line:column for a bad catalogue file, and naming the folder for a bad TEXTONBENCH_DATA.
  ///
  /// An exemplar with a known SHA-256 is available when a file with that SHA-256 lies in its package's folder or, as
  /// NAME.png (jpg, jpeg, tif, tiff, exr), in TEXTONBENCH_DATA. A file of that name with other bytes never stands in
  /// for it: how_to_get then says which file is wrong. A stack is available when each of its maps is, which are sought
  /// in the same way. Every other picture in TEXTONBENCH_DATA is an exemplar named by its file name without extension.
  explicit ExemplarCatalog(const std::filesystem::path& home);

  const std::vector<ExemplarInfo>& all() const { return all_; }
  /// Available or not. Throws std::invalid_argument for an unknown name, with the nearest one.
  const ExemplarInfo& look_up(std::string_view name) const;
  /// The same; throws also for one that is not here, with how to get it.
  const ExemplarInfo& find(std::string_view name) const;
  /// Names with that tag, available or not.
  std::vector<std::string> tagged(std::string_view tag) const;

 private:
  std::vector<ExemplarInfo> all_;
};

/// A catalogue name, or the path of a picture file, or several of them joined by "+": a stack of maps, named by its
/// files without extension. Throws as ExemplarCatalog::find for a name, and for a name or file missing beside a "+".
ExemplarInfo find_exemplar(const ExemplarCatalog& catalog, const std::string& name_or_file);

/// SHA-256 of the file's bytes; of a procedural exemplar, of its name, seed and definition; of a stack, of the names
/// and SHA-256 of its maps. Cheap: decodes nothing.
std::string exemplar_sha256(const ExemplarInfo& info);

/// Reads (or makes) the pixels. `notes` receives what image_io changed. Throws when the file is not the expected one;
/// of a stack also when sizes differ, a name comes twice, or there are more than 8 channels. Files are read with
/// `options`.
Exemplar load_exemplar(const ExemplarInfo& info, std::vector<std::string>* notes = nullptr,
                       const ReadOptions& options = {});

}  // namespace textonbench
