// Ids of places in the report.
#pragma once

#include <string>
#include <string_view>

#include "experiments/config.h"

namespace textonbench {

/// Letters, digits and underscores as they are, any other byte as "-" and two hexadecimal digits: distinct texts give
/// distinct ids.
std::string anchor_text(std::string_view text);

inline std::string record_anchor(std::string_view id) { return "r-" + std::string(id); }
inline std::string exemplar_anchor(std::string_view name) { return "e-" + anchor_text(name); }
inline std::string config_anchor(const Config& config) { return "c-" + anchor_text(config.name); }
inline std::string figure_anchor(const Config& config, const FigureTable& table) {
  return "f-" + anchor_text(config.name) + "." + anchor_text(table.name);
}

}  // namespace textonbench
