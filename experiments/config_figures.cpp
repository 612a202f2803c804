#include "experiments/config_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace textonbench {
namespace {

void read_figure_option(FigureTable& figure, const TomlEntry& entry) {
  note_places(figure.places, entry.key, entry.value);
  const auto* list = std::get_if<std::vector<TomlValue>>(&entry.value.data);
  if (list == nullptr) {
    figure.options.emplace(entry.key, read_scalar(entry.value, entry.key));
  } else if (!list->empty() && std::holds_alternative<TomlTable>(list->front().data)) {
    for (const TomlValue& element : *list) {
      figure.lists[entry.key].push_back(read_scalars(element, entry.key));
    }
  } else {
    for (const TomlValue* element : read_axis(entry.value, entry.key)) {
      figure.arrays[entry.key].push_back(read_scalar(*element, entry.key));
    }
  }
}

FigureTable read_keys(const TomlValue& value) {
  FigureTable figure;
  figure.place = value.place;
  TableReader reader(value, "[[figures]]");
  figure.name = read_identifier(reader.require("name").value, "name");
  figure.kind = read_text(reader.require("kind").value, "kind");
  figure.title = read_text(reader.require("title").value, "title");
  if (const TomlEntry* caption = reader.find("caption")) {
    figure.caption = read_text(caption->value, "caption");
  }
  if (const TomlEntry* runs = reader.find("runs")) {
    figure.runs = read_texts(runs->value, "runs");
  }
  constexpr std::array<std::string_view, 4> common{"name", "kind", "title", "caption"};
  for (const TomlEntry& entry : std::get<TomlTable>(value.data).entries) {
    if (std::ranges::find(common, entry.key) != common.end() || entry.key == "runs") {
      note_places(figure.places, entry.key, entry.value);
    } else {
      read_figure_option(figure, entry);
    }
  }
  return figure;
}

/// Everything a figure reads must be a label of `labels`: its list `runs` and the key "run" anywhere in it.
void check_labels(FigureTable& figure, const std::vector<std::string_view>& labels) {
  const auto check = [&](const ParamValue& label, const std::string& place, const auto& known, std::string_view whose) {
    const std::string text = to_string(label);
    if (std::ranges::find(known, text) == known.end()) {
      throw ConfigError(figure.places.at(place), fmt::format("unknown run \"{}\"{}; {} {}", text,
                                                             did_you_mean(text, known), whose, fmt::join(known, ", ")));
    }
  };
  for (std::size_t i = 0; i < figure.runs.size(); ++i) {
    const std::string element = fmt::format("runs[{}]", i);
    check(figure.runs[i], figure.places.contains(element) ? element : "runs", labels, "the [[runs]] tables are");
  }
  if (figure.runs.empty()) {
    figure.runs.assign(labels.begin(), labels.end());
  }
  const std::vector<std::string_view> own(figure.runs.begin(), figure.runs.end());
  if (const auto run = figure.options.find("run"); run != figure.options.end()) {
    check(run->second, "run", own, "this figure's runs are");
  }
  for (const auto& [key, tables] : figure.lists) {
    for (std::size_t i = 0; i < tables.size(); ++i) {
      if (const auto run = tables[i].find("run"); run != tables[i].end()) {
        check(run->second, fmt::format("{}[{}].run", key, i), own, "this figure's runs are");
      }
    }
  }
}

}  // namespace

FigureTable read_figure_table(const TomlValue& value, const std::vector<std::string_view>& labels) {
  FigureTable figure = read_keys(value);
  check_labels(figure, labels);
  return figure;
}

}  // namespace textonbench
