// A home folder with a small exemplar catalog of its own, so that tests depend on no installed package.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "experiments/provenance.h"
#include "methods/base/image_io.h"
#include "tests/temporary_folder.h"
#include "tests/texture.h"

namespace textonbench {

/// TEXTONBENCH_DATA for the duration of a test; an empty path unsets it.
class DataVariable {
 public:
  explicit DataVariable(const std::filesystem::path& folder) {
    if (const char* before = std::getenv("TEXTONBENCH_DATA")) before_ = before;
    set(folder.string());
  }
  DataVariable(const DataVariable&) = delete;
  DataVariable& operator=(const DataVariable&) = delete;
  ~DataVariable() { set(before_); }

 private:
  static void set(const std::string& value) {
    value.empty() ? unsetenv("TEXTONBENCH_DATA") : setenv("TEXTONBENCH_DATA", value.c_str(), 1);
  }
  std::string before_;
};

/// "grass" is installed, "sand" is in a package that is not, "paper" and "paper_2" can only be had as files of the user
/// with a certain SHA-256.
class ExemplarHome {
 public:
  ExemplarHome() {
    namespace fs = std::filesystem;
    fs::create_directories(folder_.path() / "configs");
    fs::create_directories(folder_.path() / "installed");
    fs::create_directories(data());
    write_picture(folder_.path() / "installed" / "green.png", 1);
    write_picture(folder_.path() / "paper.png", 2);
    const std::string tables = R"([[package]]
name = "meadow-data"
source = "Debian meadow-data"
licence = "CC0-1.0"
how_to_get = "apt-get install meadow-data"
folder = "FOLDER/installed"

[[package]]
name = "beach-data"
source = "Debian beach-data"
licence = "GPL-2.0-or-later"
how_to_get = "apt-get install beach-data"
folder = "FOLDER/not_installed"

[[package]]
name = "archive"
source = "The paper's archive"
licence = "not stated"
how_to_get = "take it from the archive"

[[exemplar]]
name = "grass"
package = "meadow-data"
file = "green.png"
sha256 = "GRASS"
tags = ["default", "micro"]

[[exemplar]]
name = "sand"
package = "beach-data"
file = "sand.png"
tags = ["default"]

[[exemplar]]
name = "paper"
package = "archive"
sha256 = "PAPER"
tags = ["paper"]

[[exemplar]]
name = "paper_2"
package = "archive"
sha256 = "0000000000000000000000000000000000000000000000000000000000000000"
tags = ["paper"]
)";
    write_catalog(tables);
  }

  const std::filesystem::path& path() const { return folder_.path(); }
  std::filesystem::path data() const { return folder_.path() / "data"; }
  std::filesystem::path catalog() const { return folder_.path() / "configs" / "exemplars.toml"; }
  /// The right picture for the exemplar "paper".
  std::filesystem::path paper() const { return folder_.path() / "paper.png"; }
  std::filesystem::path grass() const { return folder_.path() / "installed" / "green.png"; }

  /// FOLDER, GRASS and PAPER stand for this folder and the hashes of the two pictures.
  void write_catalog(std::string text) const {
    replace(text, "FOLDER", folder_.path().string());
    replace(text, "GRASS", sha256_of_file(grass()));
    replace(text, "PAPER", sha256_of_file(paper()));
    std::ofstream(catalog()) << text;
  }

  static void write_picture(const std::filesystem::path& file, std::uint64_t seed) {
    write_image(test_texture({24, 16}, 3, seed), file);
  }

 private:
  static void replace(std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  }
  TemporaryFolder folder_;
};

}  // namespace textonbench
