// The house stands on its floors: a source includes only its own folder and those below it, by the path from the root,
// and a third-party library that can be replaced is included in one place.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace textonbench::floors_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Each folder with those that it may include besides itself. A leading folder stands for what lies below it too,
/// unless that has a line of its own. "methods/*" is any family of methods, which does not know the other families. Of
/// what lies above, metrics of a family's models and the command line know families; what runs and compares does not.
const std::map<std::string, std::vector<std::string>, std::less<>> foundations = {
    {"methods/base", {}},
    {"methods", {"methods/base"}},
    {"methods/*", {"methods", "methods/base"}},
    {"gpu", {"methods/base"}},
    {"experiments/metrics", {"methods", "methods/*", "methods/base"}},
    {"experiments", {"experiments/metrics", "methods", "methods/base", "gpu"}},
    {"paper_figures", {"experiments", "experiments/metrics", "methods", "methods/base"}},
    {"experiments/cli",
     {"paper_figures", "experiments", "experiments/metrics", "methods", "methods/*", "methods/base", "gpu"}},
};

/// Headers of libraries (by their beginning) with the files (by theirs) that may include them.
const std::map<std::string, std::vector<std::string>, std::less<>> library_users = {
    {"OpenImageIO/", {"methods/base/image_io"}},      {"fftw3", {"methods/base/fft_plan.cpp"}},
    {"Random123/", {"methods/base/random"}},          {"toml++/", {"experiments/toml_reader"}},
    {"openssl/", {"experiments/provenance"}},         {"kainjow/", {"paper_figures/"}},
    {"sqlite3", {"paper_figures/export_sqlite.cpp"}}, {"CLI/", {"experiments/cli/"}},
};

/// The folder of `foundations` that a path from the root belongs to, or "methods/NAME" for a family; empty when none.
std::string folder_of(std::string_view path) {
  const std::string parent = fs::path(path).parent_path().generic_string();
  for (std::string folder = parent; !folder.empty(); folder = fs::path(folder).parent_path().generic_string()) {
    if (fs::path(folder).parent_path() == "methods" && folder != "methods/base") return folder;
    if (foundations.contains(folder)) return folder;
  }
  return {};
}

bool is_family(const std::string& folder) { return folder.starts_with("methods/") && folder != "methods/base"; }

/// Why `file` may not include `header` (both from the root), or nothing.
std::string floor_violation(std::string_view file, std::string_view header) {
  const std::string from = folder_of(file);
  const std::string to = folder_of(header);
  if (to.empty()) return "is not a path from the root into a folder of the house";
  if (from == to || (file == "methods/catalog.cpp" && is_family(to))) return {};
  const std::vector<std::string>& allowed = foundations.at(is_family(from) ? "methods/*" : from);
  if (std::ranges::find(allowed, is_family(to) ? "methods/*" : to) != allowed.end()) return {};
  return from + " does not stand on " + to;
}

/// Why `file` may not include <`header`>, or nothing.
std::string library_violation(std::string_view file, std::string_view header) {
  for (const auto& [library, users] : library_users) {
    if (!header.starts_with(library)) continue;
    if (std::ranges::any_of(users, [&](const std::string& user) { return file.starts_with(user); })) return {};
    return "only " + users.front() + " includes " + library;
  }
  return {};
}

/// All violations in the text of `file`, as "file:line: #include …: reason".
std::vector<std::string> violations(const std::string& file, const std::string& text) {
  static const std::regex include(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  std::vector<std::string> found;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, include)) continue;
    const std::string header = match[2];
    const std::string reason = match[1] == "<" ? library_violation(file, header) : floor_violation(file, header);
    if (!reason.empty()) found.push_back(fmt::format("{}:{}: {}: {}", file, number, line, reason));
  }
  return found;
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Floors, NoSourceIncludesUpwardOrSideways) {
  const fs::path root = TEXTONBENCH_SOURCE_DIR;
  int sources = 0;
  for (const char* top : {"methods", "gpu", "experiments", "paper_figures"}) {
    if (!fs::exists(root / top)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / top)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      ++sources;
      for (const std::string& violation :
           violations(entry.path().lexically_relative(root).generic_string(), read_text(entry.path()))) {
        ADD_FAILURE() << violation;
      }
    }
  }
  EXPECT_GT(sources, 50);
}

TEST(Floors, PlantedIncludesAreJudged) {
  struct Case {
    const char *file, *include, *reason;  // no reason: allowed
  };
  for (const Case& planted : {
           Case{"methods/base/fft.cpp", "\"methods/base/image.h\"", ""},
           Case{"methods/base/fft.cpp", "\"methods/method.h\"", "methods/base does not stand on methods"},
           Case{"methods/base/fft.cpp", "\"experiments/record.h\"", "methods/base does not stand on experiments"},
           Case{"methods/spectral/rpn.cpp", "\"methods/spectral/rpn.h\"", ""},
           Case{"methods/spectral/rpn.cpp", "\"methods/method.h\"", ""},
           Case{"methods/spectral/rpn.cpp", "\"methods/base/fft.h\"", ""},
           Case{"methods/spectral/rpn.cpp", "\"methods/spot/dsn.h\"",
                "methods/spectral does not stand on methods/spot"},
           Case{"methods/catalog.cpp", "\"methods/spectral/rpn.h\"", ""},
           Case{"methods/method.h", "\"methods/spectral/rpn.h\"", "methods does not stand on methods/spectral"},
           Case{"gpu/renderer.cpp", "\"methods/base/image.h\"", ""},
           Case{"gpu/renderer.cpp", "\"methods/method.h\"", "gpu does not stand on methods"},
           Case{"methods/spot/texton_noise.cpp", "\"gpu/renderer.h\"", "methods/spot does not stand on gpu"},
           Case{"experiments/metrics/energy.cpp", "\"experiments/record.h\"", "does not stand on experiments"},
           Case{"experiments/runner.cpp", "\"experiments/metrics/metric.h\"", ""},
           Case{"experiments/runner.cpp", "\"methods/spectral/rpn.h\"", "does not stand on methods/spectral"},
           Case{"experiments/runner.cpp", "\"paper_figures/report.h\"", "does not stand on paper_figures"},
           Case{"experiments/runner.cpp", "\"experiments/cli/options.h\"", "does not stand on experiments/cli"},
           Case{"paper_figures/report.cpp", "\"experiments/record.h\"", ""},
           Case{"paper_figures/report.cpp", "\"experiments/cli/options.h\"", "does not stand on experiments/cli"},
           Case{"experiments/cli/main.cpp", "\"paper_figures/report.h\"", ""},
           Case{"experiments/runner.cpp", "\"record.h\"", "is not a path from the root"},
           Case{"experiments/runner.cpp", "\"../methods/method.h\"", "is not a path from the root"},
           Case{"methods/base/image_io.cpp", "<OpenImageIO/imageio.h>", ""},
           Case{"methods/base/image.cpp", "<OpenImageIO/imageio.h>", "only methods/base/image_io includes"},
           Case{"paper_figures/panel.cpp", "<OpenImageIO/imageio.h>", "only methods/base/image_io includes"},
           Case{"methods/base/fft.h", "<fftw3.h>", "only methods/base/fft_plan.cpp includes"},
           Case{"methods/base/random.cpp", "<Random123/philox.h>", ""},
           Case{"methods/spectral/adsn.cpp", "<Random123/philox.h>", "only methods/base/random includes"},
           Case{"experiments/cli/main.cpp", "<CLI/CLI.hpp>", ""},
           Case{"experiments/runner.cpp", "<CLI/CLI.hpp>", "only experiments/cli/ includes"},
           Case{"experiments/runner.cpp", "<kainjow/mustache.hpp>", "only paper_figures/ includes"},
           Case{"experiments/plan.cpp", "<toml++/toml.h>", "only experiments/toml_reader includes"},
           Case{"experiments/plan.cpp", "<vector>", ""},
       }) {
    const std::vector<std::string> found =
        violations(planted.file, "#pragma once\n  #  include " + std::string(planted.include) + "  // why\n");
    if (*planted.reason == '\0') {
      EXPECT_THAT(found, testing::IsEmpty()) << planted.file;
    } else {
      const auto place = HasSubstr(std::string(planted.file) + ":2: ");
      EXPECT_THAT(found, testing::ElementsAre(testing::AllOf(place, HasSubstr(planted.reason))));
    }
  }
}

}  // namespace textonbench::floors_test
