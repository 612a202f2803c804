// The list of figure kinds, and the checks that they share.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "paper_figures/chart.h"
#include "paper_figures/curve.h"
#include "paper_figures/figure_kind.h"
#include "paper_figures/frame_table.h"
#include "paper_figures/front.h"
#include "paper_figures/panel.h"
#include "paper_figures/table.h"
#include "paper_figures/texton_table.h"

namespace textonbench {
namespace {

constexpr std::array<FigureKind, 7> kinds{{
    {"panel", check_panel, write_panel, panel_html},
    {"table", check_table, write_table, table_html},
    {"chart", check_chart, write_chart, chart_html},
    {"curve", check_curve, write_curve, curve_html},
    {"front", check_front, write_front, front_html},
    {"texton_table", check_texton_table, write_texton_table, texton_table_html},
    {"frame_table", check_frame_table, write_frame_table, frame_table_html},
}};

void require_known(const FigureTable& table, const std::string& key, std::span<const std::string_view> known) {
  if (std::ranges::find(known, key) != known.end()) return;
  throw ConfigError(place_of(table, key),
                    fmt::format("unknown key \"{}\" in a figure of kind \"{}\"{}; it knows {}", key, table.kind,
                                did_you_mean(key, known), fmt::join(known, ", ")));
}

}  // namespace

std::span<const FigureKind> figure_catalog() { return kinds; }

const FigureKind& find_figure_kind(const FigureTable& table) {
  std::vector<std::string_view> names;
  for (const FigureKind& kind : kinds) {
    if (kind.name == table.kind) return kind;
    names.push_back(kind.name);
  }
  throw ConfigError(place_of(table, "kind"),
                    fmt::format("unknown kind of figure \"{}\"{}; the kinds are {}", table.kind,
                                did_you_mean(table.kind, names), fmt::join(names, ", ")));
}

const SourcePlace& place_of(const FigureTable& table, const std::string& key) {
  const auto found = table.places.find(key);
  return found == table.places.end() ? table.place : found->second;
}

void require_known_keys(const FigureTable& table, std::initializer_list<std::string_view> options,
                        std::initializer_list<std::string_view> lists, std::initializer_list<std::string_view> arrays) {
  std::vector<std::string_view> known(options);
  known.insert(known.end(), lists);
  known.insert(known.end(), arrays);
  const auto has = [](std::initializer_list<std::string_view> names, const std::string& key) {
    return std::find(names.begin(), names.end(), key) != names.end();
  };
  const auto check = [&](const std::string& key, bool right_shape, std::string_view shape) {
    require_known(table, key, known);
    if (!right_shape) {
      throw ConfigError(place_of(table, key), fmt::format("\"{}\" cannot be {} here", key, shape));
    }
  };
  for (const auto& [key, value] : table.options) check(key, has(options, key), "a single value");
  for (const auto& [key, value] : table.lists) check(key, has(lists, key), "a list of tables");
  for (const auto& [key, value] : table.arrays) check(key, has(arrays, key), "a plain list");
}

void require_known_columns(const FigureTable& table, const std::string& list,
                           std::span<const std::string_view> required, std::span<const std::string_view> optional) {
  const auto found = table.lists.find(list);
  if (found == table.lists.end()) return;
  std::vector<std::string_view> known(required.begin(), required.end());
  known.insert(known.end(), optional.begin(), optional.end());
  for (std::size_t i = 0; i < found->second.size(); ++i) {
    for (const auto& [key, value] : found->second[i]) {
      if (std::ranges::find(known, key) == known.end()) {
        throw ConfigError(place_of(table, fmt::format("{}[{}].{}", list, i, key)),
                          fmt::format("unknown key \"{}\"{}; a table of \"{}\" knows {}", key, did_you_mean(key, known),
                                      list, fmt::join(known, ", ")));
      }
    }
    for (const std::string_view key : required) {
      if (!found->second[i].contains(std::string(key))) {
        throw ConfigError(place_of(table, list), fmt::format("table {} of \"{}\" has no \"{}\"", i + 1, list, key));
      }
    }
  }
}

}  // namespace textonbench
