// The GLSL files of gpu/shaders, which are part of the program.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "methods/base/shader_recipe.h"

namespace textonbench {

/// Text of each file by its name ("plane.glsl").
const std::map<std::string, std::string, std::less<>>& shader_files();

/// A shader made of files: each has its own number in #line directives.
struct ShaderSource {
  std::string text;
  std::vector<std::string> files;  ///< by number

  /// A driver's log with the names of the files in place of their numbers.
  std::string readable(std::string_view log) const;
};

/// `main_file` ("fragment.glsl") for a recipe: the version, CHANNELS, the recipe's defines and further ones, then the
/// file with its lines `#include "NAME"` replaced by those files, each once, and `#include RECIPE` by the recipe's.
/// Throws std::invalid_argument for a file that does not exist, naming the one that includes it.
ShaderSource shader_source(std::string_view version, std::string_view main_file, const ShaderRecipe& recipe,
                           const std::vector<std::pair<std::string, std::string>>& defines = {});

}  // namespace textonbench
