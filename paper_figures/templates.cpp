#include "paper_figures/templates.h"

#include <fmt/format.h>

#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "experiments/files.h"
#include "experiments/provenance.h"

namespace textonbench {
namespace {

namespace mustache = kainjow::mustache;

mustache::data to_mustache(const nlohmann::ordered_json& json) {
  if (json.is_object()) {
    mustache::object object;
    for (const auto& [key, value] : json.items()) object.emplace(key, to_mustache(value));
    return object;
  }
  if (json.is_array()) {
    mustache::list list;
    list.reserve(json.size());
    for (const auto& value : json) list.push_back(to_mustache(value));
    return list;
  }
  if (json.is_null()) return false;
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_string()) return json.get<std::string>();
  return json.dump();
}

}  // namespace

std::string template_file(std::string_view name) {
  return read_file(home_folder() / "paper_figures" / "templates" / name);
}

std::string render_template(std::string_view name, const nlohmann::ordered_json& data) {
  const std::string file = std::string(name) + ".mustache";
  mustache::mustache text(template_file(file));
  std::string rendered = text.render(to_mustache(data));
  if (!text.is_valid()) throw std::runtime_error(fmt::format("report template {}: {}", file, text.error_message()));
  return rendered;
}

}  // namespace textonbench
