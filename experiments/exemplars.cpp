#include "experiments/exemplars.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "experiments/exemplar_catalog_file.h"
#include "experiments/exemplar_stack.h"
#include "experiments/procedural_exemplars.h"
#include "experiments/provenance.h"
#include "methods/base/params.h"

namespace textonbench {
namespace {

namespace fs = std::filesystem;

constexpr const char* data_variable = "TEXTONBENCH_DATA";

using DataFiles = std::map<std::string, std::vector<fs::path>>;

bool is_picture(const fs::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* known : {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr"}) {
    if (extension == known) {
      return true;
    }
  }
  return false;
}

/// Pictures of the user's folder by file name without extension, in alphabetical order.
DataFiles read_data_folder() {
  DataFiles files;
  const char* value = std::getenv(data_variable);
  if (value == nullptr || *value == '\0') {
    return files;
  }
  try {
    for (const auto& entry : fs::directory_iterator(value)) {
      if (entry.is_regular_file() && is_picture(entry.path())) {
        files[entry.path().stem().string()].push_back(entry.path());
      }
    }
  } catch (const fs::filesystem_error& error) {
    throw std::invalid_argument(
        fmt::format("{}={}: expected a folder that can be read ({})", data_variable, value, error.code().message()));
  }
  for (auto& [stem, paths] : files) {
    std::ranges::sort(paths);
  }
  return files;
}

/// Why the file is not the expected one; nothing when it is.
std::optional<std::string> mismatch(const fs::path& file, const std::string& expected) {
  const std::string found = expected.empty() ? expected : sha256_of_file(file);
  if (found == expected) {
    return std::nullopt;
  }
  return fmt::format("{} is another picture (SHA-256 {}, expected {})", file.string(), found, expected);
}

const std::vector<fs::path>& files_named(const DataFiles& data, const std::string& name) {
  static const std::vector<fs::path> none;
  const auto found = data.find(name);
  return found == data.end() ? none : found->second;
}

/// Whoever's picture has the name of an exemplar that no picture can be stands in the way.
void refuse_own_file(ExemplarInfo& info, const std::vector<fs::path>& own, const char* kind) {
  if (!own.empty()) {
    info.available = false;
    info.file = own.front();
    info.how_to_get = fmt::format("{} has the name of a {}: rename it", info.file.string(), kind);
  }
}

ExemplarInfo locate(CatalogRow row, const DataFiles& data);

ExemplarInfo locate_stack(CatalogRow row, const DataFiles& data) {
  ExemplarInfo& info = row.info;
  info.available = true;
  for (CatalogRow& map : row.maps) {
    const ExemplarInfo& found = info.maps.emplace_back(locate(std::move(map), data));
    if (!found.available && info.available) {
      info.available = false;
      info.file = found.file;
      info.how_to_get = fmt::format("map {}: {}", found.name, found.how_to_get);
    }
  }
  refuse_own_file(info, files_named(data, info.name), "stack of maps");
  return info;
}

/// Decides whether the exemplar is here, and with which file: the installed one, or the user's own of that name.
ExemplarInfo locate(CatalogRow row, const DataFiles& data) {
  if (!row.maps.empty()) {
    return locate_stack(std::move(row), data);
  }
  ExemplarInfo& info = row.info;
  if (std::error_code error; fs::is_regular_file(row.installed, error)) {
    if (const auto wrong = mismatch(row.installed, info.expected_sha256)) {
      info.how_to_get = fmt::format("{}; {}", *wrong, info.how_to_get);
    } else {
      info.file = row.installed;
    }
  }
  for (const fs::path& candidate : files_named(data, info.name)) {
    if (const auto wrong = mismatch(candidate, info.expected_sha256)) {
      info.file = candidate;
      info.how_to_get = fmt::format("{}: rename or remove it; {}", *wrong, info.how_to_get);
      return info;
    }
    if (info.file.empty()) {
      info.file = candidate;
    }
  }
  info.available = !info.file.empty();
  return info;
}

ExemplarInfo procedural_info(const ProceduralExemplar& exemplar) {
  return {.name = std::string(exemplar.name),
          .available = true,
          .file = {},
          .source = fmt::format("procedural, seed {}: {}", exemplar.seed.value, exemplar.title),
          .licence = "CC0-1.0",
          .how_to_get = {},
          .expected_sha256 = {},
          .tags = exemplar.maps.empty() ? std::vector<std::string>{"default", "procedural", "micro"}
                                        : std::vector<std::string>{"stack"}};
}

ExemplarInfo own_info(const std::string& name, const std::vector<fs::path>& files) {
  ExemplarInfo info{.name = name,
                    .available = files.size() == 1,
                    .file = files.front(),
                    .source = data_variable,
                    .licence = "not stated",
                    .how_to_get = {},
                    .expected_sha256 = {},
                    .tags = {}};
  if (!info.available) {
    info.how_to_get =
        fmt::format("{} and {} would have the same name: rename one", files[0].string(), files[1].filename().string());
  }
  return info;
}

const ProceduralExemplar& find_procedural(std::string_view name) {
  const auto found = std::ranges::find(procedural_exemplars(), name, &ProceduralExemplar::name);
  if (found == procedural_exemplars().end()) {
    throw std::invalid_argument(fmt::format("exemplar \"{}\" has no file and is not procedural", name));
  }
  return *found;
}

void require_available(const ExemplarInfo& info) {
  if (!info.available) {
    throw std::invalid_argument(fmt::format("exemplar \"{}\" is not available here: {}", info.name, info.how_to_get));
  }
}

}  // namespace

ExemplarCatalog::ExemplarCatalog(const fs::path& home) {
  auto data = read_data_folder();
  for (CatalogRow& row : read_exemplar_catalog(home / "configs" / "exemplars.toml")) {
    all_.push_back(locate(std::move(row), data));
  }
  for (const ProceduralExemplar& exemplar : procedural_exemplars()) {
    ExemplarInfo info = procedural_info(exemplar);
    refuse_own_file(info, files_named(data, info.name), "procedural exemplar");
    all_.push_back(std::move(info));
  }
  for (const ExemplarInfo& known : all_) {
    data.erase(known.name);
  }
  for (const auto& [name, files] : data) {
    all_.push_back(own_info(name, files));
  }
}

const ExemplarInfo& ExemplarCatalog::look_up(std::string_view name) const {
  if (const auto found = std::ranges::find(all_, name, &ExemplarInfo::name); found != all_.end()) {
    return *found;
  }
  std::vector<std::string_view> names;
  for (const ExemplarInfo& info : all_) {
    names.push_back(info.name);
  }
  throw std::invalid_argument(fmt::format("unknown exemplar \"{}\"{}; \"textonbench list exemplars\" shows all", name,
                                          did_you_mean(name, names)));
}

const ExemplarInfo& ExemplarCatalog::find(std::string_view name) const {
  const ExemplarInfo& info = look_up(name);
  require_available(info);
  return info;
}

std::vector<std::string> ExemplarCatalog::tagged(std::string_view tag) const {
  std::vector<std::string> names;
  for (const ExemplarInfo& info : all_) {
    if (std::ranges::find(info.tags, tag) != info.tags.end()) {
      names.push_back(info.name);
    }
  }
  return names;
}

ExemplarInfo find_exemplar(const ExemplarCatalog& catalog, const std::string& name_or_file) {
  const std::filesystem::path path = name_or_file;
  const bool known = std::any_of(catalog.all().begin(), catalog.all().end(),
                                 [&](const ExemplarInfo& info) { return info.name == name_or_file; });
  if (known) return catalog.find(name_or_file);
  std::error_code ignored;
  if (name_or_file.find('+') != std::string::npos && !fs::exists(path, ignored)) {
    return find_stack(catalog, name_or_file);
  }
  if (!path.has_extension() && !path.has_parent_path()) return catalog.find(name_or_file);
  ExemplarInfo info;
  info.name = path.stem().string();
  info.available = true;
  info.file = path;
  info.source = "file";
  return info;
}

std::string exemplar_sha256(const ExemplarInfo& info) {
  require_available(info);
  if (!info.maps.empty()) {
    std::string maps = "stack of maps";
    for (const ExemplarInfo& map : info.maps) maps += fmt::format(", {} {}", map.name, exemplar_sha256(map));
    return sha256(maps);
  }
  if (info.file.empty()) {
    return sha256(fmt::format("procedural exemplar {}, seed {}, definition {}", info.name,
                              find_procedural(info.name).seed.value, procedural_definition));
  }
  return sha256_of_file(info.file);
}

Exemplar load_exemplar(const ExemplarInfo& info, std::vector<std::string>* notes, const ReadOptions& options) {
  require_available(info);
  if (!info.maps.empty()) {
    return load_stack(info, notes, options);
  }
  if (info.file.empty()) {
    const ProceduralExemplar& exemplar = find_procedural(info.name);
    return {info.name, draw_procedural(info.name, exemplar.seed), exemplar_sha256(info), exemplar.maps};
  }
  if (const auto wrong = mismatch(info.file, info.expected_sha256)) {
    throw std::invalid_argument(fmt::format("exemplar \"{}\": {}", info.name, *wrong));
  }
  ReadResult result = read_image(info.file, options);
  if (notes != nullptr) {
    notes->insert(notes->end(), result.notes.begin(), result.notes.end());
  }
  return {info.name, std::move(result.image), sha256_of_file(info.file), std::move(result.maps)};
}

}  // namespace textonbench
