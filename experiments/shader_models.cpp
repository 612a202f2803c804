#include "experiments/shader_models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

namespace textonbench {

std::vector<std::string> methods_with_shader() {
  constexpr Extent size{64, 64};  // beyond the usual supports
  Exemplar exemplar{.name = "noise", .pixels = Image(size, 1), .sha256 = ""};
  for (int y = 0; y < size.height; ++y) {
    fill_normal(Stream(Seed{1}), static_cast<std::uint64_t>(y), 0, exemplar.pixels.row(0, y));
  }
  const Problem problem{.exemplar = exemplar, .second = &exemplar};
  std::vector<std::string> names;
  for (const MethodEntry& method : method_catalog()) {
    const Params params(method.params, {});
    try {
      if (!method.refuses(problem, params, {.size = size}) &&
          method.analyze(problem, params, Seed{1})->shader({.seed = Seed{1}})) {
        names.emplace_back(method.name);
      }
    } catch (const std::invalid_argument&) {
      // A method that cannot serve this exemplar is none to recommend.
    }
  }
  return names;
}

ShaderRecipe shader_of(const Model& model, std::string_view method, const ShaderRequest& request) {
  std::optional<ShaderRecipe> recipe = model.shader(request);
  if (recipe) return *std::move(recipe);
  const std::vector<std::string> drawn = methods_with_shader();
  throw std::invalid_argument(fmt::format(
      "{} {} for a graphics processor: expected one of {}", method,
      std::ranges::find(drawn, method) == drawn.end() ? "has no shader" : "with these options has no shader",
      fmt::join(drawn, ", ")));
}

}  // namespace textonbench
