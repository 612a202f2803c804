// TOML files as plain values that know their place. The only file pair that includes toml++.
//
// Every function that refuses a value throws ConfigError with the place of that value, what was expected and what was
// found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "experiments/config.h"
#include "methods/base/params.h"

namespace textonbench {

struct TomlEntry;

/// Entries in alphabetical order of their keys.
struct TomlTable {
  std::vector<TomlEntry> entries;
};

struct TomlValue {
  SourcePlace place;
  std::variant<bool, std::int64_t, double, std::string, std::vector<TomlValue>, TomlTable> data;
};

struct TomlEntry {
  std::string key;
  SourcePlace place;  ///< of the key
  TomlValue value;
};

/// The root table. Throws std::invalid_argument naming the file when it cannot be read, ConfigError for a syntax error,
/// a number that is not finite, or a date (nothing here takes one).
TomlValue read_toml(const std::filesystem::path& file);

/// Reads a table key by key; what nobody asked for is then an error, so no key can be misspelt in silence.
class TableReader {
 public:
  /// `name` stands for the table in messages: "[[runs]]". `value` must outlive the reader; throws unless it is a table.
  TableReader(const TomlValue& value, std::string name);

  /// The entry of that key, or null; either way the key is a known one from now on.
  const TomlEntry* find(std::string_view key);
  const TomlEntry& require(std::string_view key);
  /// Throws for the first entry whose key was never asked for, with the nearest known key.
  void refuse_unknown_keys() const;

  const SourcePlace& place() const { return place_; }

 private:
  const TomlTable* table_;
  SourcePlace place_;
  std::string name_;
  std::vector<std::string_view> known_;
};

/// The value of one kind. `key` stands for it in messages.
bool read_bool(const TomlValue& value, std::string_view key);
std::int64_t read_integer(const TomlValue& value, std::string_view key, std::int64_t min, std::int64_t max);
/// A real or whole number in (0, max].
double read_positive(const TomlValue& value, std::string_view key, double max);
std::string read_text(const TomlValue& value, std::string_view key);
/// A name without spaces that is safe as a file name: letters, digits, "_", "-" and ".", not starting with ".".
std::string read_identifier(const TomlValue& value, std::string_view key);
ParamValue read_scalar(const TomlValue& value, std::string_view key);
const std::vector<TomlValue>& read_list(const TomlValue& value, std::string_view key);

/// The elements of a list, or the value itself as the only one. Throws for an empty list: an empty sweep.
std::vector<const TomlValue*> read_axis(const TomlValue& value, std::string_view key);
std::vector<std::string> read_texts(const TomlValue& value, std::string_view key);

/// A table of scalars, {key = value, …}.
std::map<std::string, ParamValue> read_scalars(const TomlValue& value, std::string_view key);
/// The elements of an array of tables such as [[runs]].
const std::vector<TomlValue>& read_tables(const TomlEntry& entry);

/// Notes where a value and everything inside it stands, as "seeds", "seeds[1]", "params.order"; and where a key inside
/// it stands, as key_path("params.order").
std::string key_path(const std::string& path);
void note_places(std::map<std::string, SourcePlace>& places, const std::string& path, const TomlValue& value);

}  // namespace textonbench
