#include "experiments/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>

#include "experiments/config_figures.h"
#include "experiments/toml_reader.h"

namespace textonbench {
namespace {

constexpr int largest_side = 65536;
constexpr std::int64_t largest_area = std::int64_t{1} << 28;
constexpr int most_samples = 1'000'000;
constexpr std::int64_t largest_memory_limit_mb = std::int64_t{1} << 30;
constexpr double longest_timeout_seconds = 7 * 24 * 3600.0;

Extent read_extent(const TomlValue& value) {
  const auto& sides = read_list(value, "size");
  if (sides.size() != 2) {
    throw ConfigError(value.place, fmt::format("size: expected [width, height], found a list of {}", sides.size()));
  }
  const Extent extent{static_cast<int>(read_integer(sides[0], "size", 0, largest_side)),
                      static_cast<int>(read_integer(sides[1], "size", 0, largest_side))};
  const bool own_size = extent == Extent{};
  if (!own_size && (extent.width == 0 || extent.height == 0 || extent.area() > largest_area)) {
    throw ConfigError(value.place,
                      fmt::format("size: expected two sides of at least 1 and at most {} pixels in all, or "
                                  "[0, 0] for the exemplar's own size, found [{}, {}]",
                                  largest_area, extent.width, extent.height));
  }
  return extent;
}

std::vector<Extent> read_sizes(const TomlValue& value) {
  const auto elements = read_axis(value, "size");
  if (std::holds_alternative<std::int64_t>(elements.front()->data)) {
    return {read_extent(value)};
  }
  std::vector<Extent> sizes;
  sizes.reserve(elements.size());
  for (const TomlValue* element : elements) {
    sizes.push_back(read_extent(*element));
  }
  return sizes;
}

/// Names may be none at all: no metric, or no picture.
std::vector<std::string> read_names(const TomlValue& value, std::string_view key) {
  const auto* list = std::get_if<std::vector<TomlValue>>(&value.data);
  return list != nullptr && list->empty() ? std::vector<std::string>{} : read_texts(value, key);
}

/// Reads the keys that [defaults], [profile.…] and [[runs]] share over what `runs` held before.
void read_layer(TableReader& layer, RunsTable& runs) {
  const auto read = [&](std::string_view key, const auto& assign) {
    if (const TomlEntry* entry = layer.find(key)) {
      note_places(runs.places, entry->key, entry->value);
      assign(entry->value);
    }
  };
  read("method", [&](const TomlValue& v) { runs.methods = read_texts(v, "method"); });
  read("exemplars", [&](const TomlValue& v) { runs.exemplars = read_texts(v, "exemplars"); });
  read("seeds", [&](const TomlValue& v) {
    runs.seeds.clear();
    for (const TomlValue* element : read_axis(v, "seeds")) {
      const auto seed = read_integer(*element, "seeds", 0, std::numeric_limits<std::int64_t>::max());
      runs.seeds.push_back(static_cast<std::uint64_t>(seed));
    }
  });
  read("size", [&](const TomlValue& v) { runs.sizes = read_sizes(v); });
  read("periodic", [&](const TomlValue& v) {
    runs.periodic.clear();
    for (const TomlValue* element : read_axis(v, "periodic")) {
      runs.periodic.push_back(read_bool(*element, "periodic"));
    }
  });
  read("step", [&](const TomlValue& v) { runs.step = read_positive(v, "step", 1e6); });
  read("samples",
       [&](const TomlValue& v) { runs.samples = static_cast<int>(read_integer(v, "samples", 1, most_samples)); });
  read("timeout_seconds", [&](const TomlValue& v) {
    runs.timeout_seconds = read_positive(v, "timeout_seconds", longest_timeout_seconds);
  });
  read("memory_limit_mb", [&](const TomlValue& v) {
    runs.memory_limit_mb = static_cast<int>(read_integer(v, "memory_limit_mb", 64, largest_memory_limit_mb));
  });
  read("metrics", [&](const TomlValue& v) { runs.metrics = read_names(v, "metrics"); });
  read("pictures", [&](const TomlValue& v) { runs.pictures = read_names(v, "pictures"); });
  read("combine", [&](const TomlValue& v) {
    const std::string combine = read_text(v, "combine");
    const std::map<std::string, Combine> known{
        {"grid", Combine::grid}, {"zip", Combine::zip}, {"ablate", Combine::ablate}};
    const auto found = known.find(combine);
    if (found == known.end()) {
      throw ConfigError(v.place,
                        fmt::format("combine: expected \"grid\", \"zip\" or \"ablate\", found \"{}\"", combine));
    }
    runs.combine = found->second;
  });
  const auto read_options = [&](const char* key, std::map<std::string, std::vector<ParamValue>>& options) {
    read(key, [&](const TomlValue& v) {
      const TableReader is_a_table(v, key);
      for (const TomlEntry& entry : std::get<TomlTable>(v.data).entries) {
        const std::string path = fmt::format("{}.{}", key, entry.key);
        std::vector<ParamValue>& values = options[entry.key];
        values.clear();
        for (const TomlValue* element : read_axis(entry.value, path)) values.push_back(read_scalar(*element, path));
      }
    });
  };
  read_options("params", runs.params);
  read_options("gpu", runs.gpu);
  read("exclude", [&](const TomlValue& v) {
    runs.exclude.clear();
    for (const TomlValue& element : read_list(v, "exclude")) {
      runs.exclude.push_back(read_scalars(element, "exclude"));
    }
  });
}

/// The overrides of both profiles below the key "profile"; a missing table is an empty one. Both are checked, whichever
/// is asked for.
void read_profiles(TableReader& parent, const std::string& name, Profile wanted, RunsTable& runs) {
  const TomlEntry* profiles = parent.find("profile");
  if (profiles == nullptr) {
    return;
  }
  TableReader reader(profiles->value, name);
  for (const auto& [profile, key] : {std::pair{Profile::quick, "quick"}, std::pair{Profile::full, "full"}}) {
    if (const TomlEntry* entry = reader.find(key)) {
      TableReader layer(entry->value, fmt::format("{}.{}", name, key));
      RunsTable unused;
      read_layer(layer, profile == wanted ? runs : unused);
      layer.refuse_unknown_keys();
    }
  }
  reader.refuse_unknown_keys();
}

RunsTable read_runs_table(const TomlValue& value, Profile profile, RunsTable runs) {
  TableReader reader(value, "[[runs]]");
  const TomlEntry& name = reader.require("name");
  runs.place = value.place;
  runs.label = read_identifier(name.value, "name");
  runs.places["name"] = name.value.place;
  read_layer(reader, runs);
  read_profiles(reader, "runs.profile", profile, runs);
  reader.refuse_unknown_keys();
  for (const auto& [key, missing] :
       {std::pair{"method", runs.methods.empty()}, std::pair{"exemplars", runs.exemplars.empty()}}) {
    if (missing) {
      throw ConfigError(runs.place,
                        fmt::format("[[runs]] \"{}\" lacks the key \"{}\", and [defaults] has none", runs.label, key));
    }
  }
  return runs;
}

/// Path below the last folder called configs, or the file's own name, without extension.
std::string config_name(const std::filesystem::path& file) {
  std::filesystem::path below = file.filename();
  std::filesystem::path tail;
  for (auto path = std::filesystem::absolute(file).lexically_normal(); path.has_relative_path();
       path = path.parent_path()) {
    if (path.filename() == "configs" && !tail.empty()) {
      below = tail;
      break;
    }
    tail = tail.empty() ? path.filename() : path.filename() / tail;
  }
  return below.replace_extension().generic_string();
}

template <class Table>
void refuse_duplicate(std::set<std::string>& names, const std::string& name, const Table& table,
                      std::string_view what) {
  if (!names.insert(name).second) {
    throw ConfigError(table.places.at("name"), fmt::format("a second {} is named \"{}\"", what, name));
  }
}

}  // namespace

ConfigError::ConfigError(const SourcePlace& place, const std::string& message)
    : std::invalid_argument(fmt::format("{}:{}:{}: {}", place.file, place.line, place.column, message)) {}

Config read_config(const std::filesystem::path& file, Profile profile) {
  const TomlValue root = read_toml(file);
  TableReader reader(root, "the config");
  Config config;
  config.name = config_name(file);
  config.file = file;
  config.title = read_text(reader.require("title").value, "title");
  config.source = read_text(reader.require("source").value, "source");
  if (const TomlEntry* description = reader.find("description")) {
    config.description = read_text(description->value, "description");
  }
  if (const TomlEntry* appendix = reader.find("appendix")) {
    config.appendix = read_bool(appendix->value, "appendix");
  }

  RunsTable defaults;
  if (const TomlEntry* entry = reader.find("defaults")) {
    TableReader layer(entry->value, "[defaults]");
    read_layer(layer, defaults);
    layer.refuse_unknown_keys();
  }
  read_profiles(reader, "profile", profile, defaults);

  std::set<std::string> labels;
  for (const TomlValue& value : read_tables(reader.require("runs"))) {
    config.runs.push_back(read_runs_table(value, profile, defaults));
    refuse_duplicate(labels, config.runs.back().label, config.runs.back(), "[[runs]] table");
  }
  if (config.runs.empty()) {
    throw ConfigError(root.place, "runs: an empty list makes an empty sweep, expected at least one [[runs]] table");
  }
  std::vector<std::string_view> known;
  for (const RunsTable& runs : config.runs) {
    known.push_back(runs.label);
  }
  std::set<std::string> figures;
  if (const TomlEntry* entry = reader.find("figures")) {
    for (const TomlValue& value : read_tables(*entry)) {
      config.figures.push_back(read_figure_table(value, known));
      refuse_duplicate(figures, config.figures.back().name, config.figures.back(), "[[figures]] table");
    }
  }
  reader.refuse_unknown_keys();
  return config;
}

}  // namespace textonbench
