#include "experiments/exemplar_catalog_file.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "experiments/toml_reader.h"
#include "methods/base/params.h"

namespace textonbench {
namespace {

/// Where several exemplars come from.
struct Package {
  std::string source, licence, how_to_get;
  std::filesystem::path folder;  ///< where the package puts its files; empty when it is none of the system's
};

using Packages = std::map<std::string, Package>;

void read_package(const TomlValue& value, Packages& packages) {
  TableReader reader(value, "[[package]]");
  const TomlEntry& entry = reader.require("name");
  const std::string name = read_identifier(entry.value, "name");
  Package package{.source = read_text(reader.require("source").value, "source"),
                  .licence = read_text(reader.require("licence").value, "licence"),
                  .how_to_get = read_text(reader.require("how_to_get").value, "how_to_get"),
                  .folder = {}};
  if (const TomlEntry* folder = reader.find("folder")) {
    package.folder = read_text(folder->value, "folder");
  }
  reader.refuse_unknown_keys();
  if (!packages.emplace(name, std::move(package)).second) {
    throw ConfigError(entry.value.place, "a second [[package]] has that name");
  }
}

const Package& find_package(const Packages& packages, const TomlValue& value) {
  const std::string name = read_text(value, "package");
  if (const auto found = packages.find(name); found != packages.end()) {
    return found->second;
  }
  std::vector<std::string_view> names;
  for (const auto& [known, package] : packages) {
    names.push_back(known);
  }
  throw ConfigError(value.place, fmt::format("unknown package \"{}\"{}", name, did_you_mean(name, names)));
}

std::string read_sha256(const TomlValue& value) {
  std::string digits = read_text(value, "sha256");
  if (digits.size() != 64 || digits.find_first_not_of("0123456789abcdef") != std::string::npos) {
    throw ConfigError(value.place,
                      fmt::format("sha256: expected 64 lower-case hexadecimal digits, found \"{}\"", digits));
  }
  return digits;
}

CatalogRow blank_row(std::string name, const Package& package) {
  CatalogRow row;
  row.info.name = std::move(name);
  row.info.source = package.source;
  row.info.licence = package.licence;
  row.info.how_to_get = package.how_to_get;
  return row;
}

std::vector<CatalogRow> read_maps(const TomlValue& files, const TomlEntry* sha256, const Package& package) {
  std::vector<CatalogRow> maps;
  for (const std::string& text : read_texts(files, "files")) {
    const std::filesystem::path file = text;
    maps.push_back(blank_row(file.stem().string(), package));
    if (!package.folder.empty()) maps.back().installed = package.folder / file;
  }
  if (maps.size() < 2) throw ConfigError(files.place, "files: expected the files of at least two maps");
  if (sha256 != nullptr) {
    const std::vector<TomlValue>& list = read_list(sha256->value, "sha256");
    if (list.size() != maps.size()) {
      throw ConfigError(sha256->value.place,
                        fmt::format("sha256: expected {}, one a file, found {}", maps.size(), list.size()));
    }
    for (std::size_t i = 0; i < list.size(); ++i) maps[i].info.expected_sha256 = read_sha256(list[i]);
  }
  return maps;
}

CatalogRow read_row(const TomlValue& value, const Packages& packages) {
  TableReader reader(value, "[[exemplar]]");
  std::string name = read_identifier(reader.require("name").value, "name");
  const Package& package = find_package(packages, reader.require("package").value);
  CatalogRow row = blank_row(std::move(name), package);
  const TomlEntry* files = reader.find("files");
  const TomlEntry* sha256 = reader.find("sha256");
  if (files != nullptr) {
    row.maps = read_maps(files->value, sha256, package);
  } else {
    if (!package.folder.empty()) row.installed = package.folder / read_text(reader.require("file").value, "file");
    if (sha256 != nullptr) row.info.expected_sha256 = read_sha256(sha256->value);
  }
  if (const TomlEntry* tags = reader.find("tags")) {
    row.info.tags = read_texts(tags->value, "tags");
  }
  reader.refuse_unknown_keys();
  return row;
}

}  // namespace

std::vector<CatalogRow> read_exemplar_catalog(const std::filesystem::path& file) {
  const TomlValue root = read_toml(file);
  TableReader reader(root, "the catalog");
  Packages packages;
  for (const TomlValue& value : read_tables(reader.require("package"))) {
    read_package(value, packages);
  }
  std::vector<CatalogRow> rows;
  std::set<std::string> names;
  for (const TomlValue& value : read_tables(reader.require("exemplar"))) {
    rows.push_back(read_row(value, packages));
    if (!names.insert(rows.back().info.name).second) {
      throw ConfigError(value.place, fmt::format("a second [[exemplar]] is named \"{}\"", rows.back().info.name));
    }
  }
  reader.refuse_unknown_keys();
  return rows;
}

}  // namespace textonbench
