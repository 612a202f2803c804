#include "gpu/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace textonbench {
namespace {

class Assembly {
 public:
  explicit Assembly(std::string recipe_file) : recipe_file_(std::move(recipe_file)) {}

  void append(const std::string& name, std::string_view wanted_by) {
    if (std::ranges::find(source.files, name) != source.files.end()) {
      return;
    }
    const auto file = shader_files().find(name);
    if (file == shader_files().end()) {
      throw std::invalid_argument(fmt::format("{} wants the shader {}: there is no such file", wanted_by, name));
    }
    const std::size_t number = source.files.size();
    source.files.push_back(name);
    source.text += fmt::format("#line 1 {}\n", number);
    std::istringstream lines(file->second);
    std::string line;
    for (int at = 1; std::getline(lines, line); ++at) {
      const std::string included = included_by(line);
      if (included.empty()) {
        source.text += line + '\n';
      } else {
        append(included, fmt::format("{}:{}", name, at));
        source.text += fmt::format("#line {} {}\n", at + 1, number);
      }
    }
  }

  ShaderSource source;

 private:
  std::string included_by(const std::string& line) const {
    if (line == "#include RECIPE") {
      return recipe_file_;
    }
    static const std::regex include("#include \"([^\"]+)\"");
    std::smatch found;
    return std::regex_match(line, found, include) ? found[1].str() : std::string();
  }

  std::string recipe_file_;
};

}  // namespace

std::string ShaderSource::readable(std::string_view log) const {
  // Mesa says 2:17(5), NVIDIA 2(17).
  static const std::regex place(R"(^([0-9]+)(:([0-9]+)|\(([0-9]+)\)))");
  std::string result;
  std::istringstream lines{std::string(log)};
  std::string line;
  while (std::getline(lines, line)) {
    std::smatch found;
    if (std::regex_search(line, found, place) && found[1].length() < 4 &&
        static_cast<std::size_t>(std::stoi(found[1])) < files.size()) {
      const std::string& file = files[static_cast<std::size_t>(std::stoi(found[1]))];
      const std::string at = found[3].matched ? found[3].str() : found[4].str();
      line = fmt::format("{}:{}{}", file, at, found.suffix().str());
    }
    result += result.empty() ? line : '\n' + line;
  }
  return result;
}

ShaderSource shader_source(std::string_view version, std::string_view main_file, const ShaderRecipe& recipe,
                           const std::vector<std::pair<std::string, std::string>>& defines) {
  Assembly assembly(recipe.shader + ".glsl");
  assembly.source.text = fmt::format("#version {}\n#define CHANNELS {}\n", version, recipe.channels);
  for (const auto* all : {&recipe.defines, &defines}) {
    for (const auto& [name, value] : *all) {
      assembly.source.text += fmt::format("#define {} {}\n", name, value);
    }
  }
  assembly.append(std::string(main_file), fmt::format("the recipe of {}", recipe.shader));
  return std::move(assembly.source);
}

}  // namespace textonbench
