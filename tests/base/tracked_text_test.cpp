// What git tracks holds no path of somebody's machine and nothing that is marked as unfinished.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace textonbench::tracked_text_test {

/// Why a line of a tracked text file must not stay, or nothing.
std::string line_violation(const std::string& file, const std::string& line) {
  // Both expressions are written so that they do not find themselves.
  static const std::regex machine_path("/(home|root|work|tmp|farm)/[A-Za-z]");
  static const std::regex unfinished(
      "\\b(TO"
      "DO|FIX"
      "ME|XX"
      "X|not imple"
      "mented|place"
      "holder)\\b");
  static const std::regex checked_for_marks(R"(.*\.(cpp|h|glsl|md|toml|cmake|txt))");
  if (std::regex_search(line, machine_path)) return "names a path of one machine";
  if (std::regex_match(file, checked_for_marks) && std::regex_search(line, unfinished))
    return "is marked as unfinished";
  return {};
}

/// Paths from the root of all tracked files; empty outside a git checkout.
std::vector<std::string> tracked_files() {
  const std::string command = "git -C '" TEXTONBENCH_SOURCE_DIR "' ls-files -z 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::vector<std::string> files;
  std::string name;
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get())) {
    if (c != '\0') {
      name.push_back(static_cast<char>(c));
    } else {
      files.push_back(std::move(name));
      name.clear();
    }
  }
  return files;
}

TEST(TrackedText, HasNoMachinePathsAndNothingUnfinished) {
  const std::vector<std::string> files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout, so nothing is tracked";
  for (const std::string& file : files) {
    std::ifstream stream(TEXTONBENCH_SOURCE_DIR "/" + file, std::ios::binary);
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
      if (line.find('\0') != std::string::npos) break;  // a binary file
      const std::string reason = line_violation(file, line);
      EXPECT_EQ(reason, "") << file << ":" << number << ": " << line;
    }
  }
}

TEST(TrackedText, PlantedLinesAreJudged) {
  EXPECT_EQ(line_violation("a.cpp",
                           "open(\"/ho"
                           "me/ann/texture.png\")"),
            "names a path of one machine");
  EXPECT_EQ(line_violation(".ci/run",
                           "cd /ro"
                           "ot/checkout"),
            "names a path of one machine");
  EXPECT_EQ(line_violation("a.md", "see /usr/share/mypaint and https://example.org/homepage"), "");
  EXPECT_EQ(line_violation("a.h",
                           "// TO"
                           "DO: sort"),
            "is marked as unfinished");
  EXPECT_EQ(line_violation("a.md",
                           "This is not imple"
                           "mented."),
            "is marked as unfinished");
  EXPECT_EQ(line_violation("a.html",
                           "<input place"
                           "holder='Filter'>"),
            "");
  EXPECT_EQ(line_violation("a.cpp", "mkdtemp(\"runXXXXXX\")"), "");
}

}  // namespace textonbench::tracked_text_test
