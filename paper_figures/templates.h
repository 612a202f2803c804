// Text templates (mustache). The only file pair that includes the template library.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace textonbench {

/// Fills templates/<name>.mustache: {{key}} is escaped for HTML, {{{key}}} is not. A null or false value is an absent
/// section. Throws std::runtime_error naming the template when it is missing or malformed.
std::string render_template(std::string_view name, const nlohmann::ordered_json& data);

/// Text of a file of the templates folder ("report.css"), unchanged. Throws std::runtime_error when it is missing.
std::string template_file(std::string_view name);

/// Null, so an absent section, for an empty text.
inline nlohmann::ordered_json or_null(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

}  // namespace textonbench
