#include "experiments/toml_reader.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace textonbench {
namespace {

std::string read_bytes(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) {
    throw std::invalid_argument(fmt::format("{}: is a folder, expected a TOML file", file.string()));
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  if (!stream || (stream.peek() != std::ifstream::traits_type::eof() && !(bytes << stream.rdbuf()))) {
    throw std::invalid_argument(fmt::format("{}: cannot be read, expected a TOML file", file.string()));
  }
  return std::move(bytes).str();
}

class Converter {
 public:
  explicit Converter(std::string file) : file_(std::move(file)) {}

  TomlValue convert(const toml::node& node) const {
    TomlValue value{place(node.source()), false};
    if (const auto* table = node.as_table()) {
      TomlTable entries;
      for (const auto& [key, child] : *table) {
        entries.entries.push_back({std::string(key.str()), place(key.source()), convert(child)});
      }
      value.data = std::move(entries);
    } else if (const auto* array = node.as_array()) {
      std::vector<TomlValue> list;
      for (const auto& child : *array) {
        list.push_back(convert(child));
      }
      value.data = std::move(list);
    } else if (const auto* text = node.as_string()) {
      value.data = text->get();
    } else if (const auto* integer = node.as_integer()) {
      value.data = integer->get();
    } else if (const auto* real = node.as_floating_point()) {
      if (!std::isfinite(real->get())) {
        throw ConfigError(value.place, fmt::format("expected a finite number, found {}", real->get()));
      }
      value.data = real->get();
    } else if (const auto* boolean = node.as_boolean()) {
      value.data = boolean->get();
    } else {
      throw ConfigError(value.place,
                        "expected a string, a number, true, false, a list or a table, found a date or time");
    }
    return value;
  }

  SourcePlace place(const toml::source_region& region) const { return {file_, region.begin.line, region.begin.column}; }

 private:
  std::string file_;
};

std::string describe(const TomlValue& value) {
  struct Describer {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return fmt::format("the whole number {}", v); }
    std::string operator()(double v) const { return fmt::format("the number {}", v); }
    std::string operator()(const std::string& v) const { return fmt::format("the string \"{}\"", v); }
    std::string operator()(const std::vector<TomlValue>&) const { return "a list"; }
    std::string operator()(const TomlTable&) const { return "a table"; }
  };
  return std::visit(Describer{}, value.data);
}

[[noreturn]] void fail(const TomlValue& value, std::string_view key, std::string_view expected) {
  throw ConfigError(value.place, fmt::format("{}: expected {}, found {}", key, expected, describe(value)));
}

}  // namespace

TomlValue read_toml(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  const Converter converter(file.string());
  try {
    return converter.convert(toml::parse(std::string_view(bytes), std::string_view(file.native())));
  } catch (const toml::parse_error& error) {
    throw ConfigError(converter.place(error.source()), std::string(error.description()));
  }
}

TableReader::TableReader(const TomlValue& value, std::string name)
    : table_(std::get_if<TomlTable>(&value.data)), place_(value.place), name_(std::move(name)) {
  if (table_ == nullptr) {
    fail(value, name_, "a table");
  }
}

const TomlEntry* TableReader::find(std::string_view key) {
  known_.push_back(key);
  const auto entry = std::ranges::find(table_->entries, key, &TomlEntry::key);
  return entry == table_->entries.end() ? nullptr : &*entry;
}

const TomlEntry& TableReader::require(std::string_view key) {
  if (const TomlEntry* entry = find(key)) {
    return *entry;
  }
  for (const TomlEntry& entry : table_->entries) {
    const std::string_view candidate[] = {key};
    if (std::ranges::find(known_, entry.key) == known_.end() && !nearest_name(entry.key, candidate).empty()) {
      throw ConfigError(entry.place, fmt::format("{} lacks the key \"{}\" (is it \"{}\"?)", name_, key, entry.key));
    }
  }
  throw ConfigError(place_, fmt::format("{} lacks the key \"{}\"", name_, key));
}

void TableReader::refuse_unknown_keys() const {
  for (const TomlEntry& entry : table_->entries) {
    if (std::ranges::find(known_, entry.key) == known_.end()) {
      throw ConfigError(entry.place, fmt::format("unknown key \"{}\" in {}{}; expected one of: {}", entry.key, name_,
                                                 did_you_mean(entry.key, known_), fmt::join(known_, ", ")));
    }
  }
}

bool read_bool(const TomlValue& value, std::string_view key) {
  const bool* flag = std::get_if<bool>(&value.data);
  if (flag == nullptr) {
    fail(value, key, "true or false");
  }
  return *flag;
}

std::int64_t read_integer(const TomlValue& value, std::string_view key, std::int64_t min, std::int64_t max) {
  const std::int64_t* integer = std::get_if<std::int64_t>(&value.data);
  if (integer == nullptr || *integer < min || *integer > max) {
    fail(value, key, fmt::format("a whole number from {} to {}", min, max));
  }
  return *integer;
}

double read_positive(const TomlValue& value, std::string_view key, double max) {
  double number = 0;
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) {
    number = static_cast<double>(*integer);
  } else if (const auto* real = std::get_if<double>(&value.data)) {
    number = *real;
  }
  if (number <= 0 || number > max) {
    fail(value, key, fmt::format("a number above 0 and at most {}", max));
  }
  return number;
}

std::string read_text(const TomlValue& value, std::string_view key) {
  const std::string* text = std::get_if<std::string>(&value.data);
  if (text == nullptr || text->empty()) {
    fail(value, key, "a string that is not empty");
  }
  return *text;
}

std::string read_identifier(const TomlValue& value, std::string_view key) {
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  std::string text = read_text(value, key);
  if (text.front() == '.' || text.find_first_not_of(allowed) != std::string::npos) {
    fail(value, key, "a name of letters, digits, \"_\", \"-\" and \".\" that does not start with \".\"");
  }
  return text;
}

ParamValue read_scalar(const TomlValue& value, std::string_view key) {
  return std::visit(
      [&](const auto& data) -> ParamValue {
        if constexpr (std::is_constructible_v<ParamValue, decltype(data)>) {
          return data;
        } else {
          fail(value, key, "a string, a number, true or false");
        }
      },
      value.data);
}

const std::vector<TomlValue>& read_list(const TomlValue& value, std::string_view key) {
  const auto* list = std::get_if<std::vector<TomlValue>>(&value.data);
  if (list == nullptr) {
    fail(value, key, "a list");
  }
  return *list;
}

std::vector<const TomlValue*> read_axis(const TomlValue& value, std::string_view key) {
  const auto* list = std::get_if<std::vector<TomlValue>>(&value.data);
  if (list == nullptr) {
    return {&value};
  }
  if (list->empty()) {
    throw ConfigError(value.place,
                      fmt::format("{}: an empty list makes an empty sweep, expected at least one value", key));
  }
  std::vector<const TomlValue*> elements;
  for (const TomlValue& element : *list) {
    elements.push_back(&element);
  }
  return elements;
}

std::vector<std::string> read_texts(const TomlValue& value, std::string_view key) {
  std::vector<std::string> texts;
  for (const TomlValue* element : read_axis(value, key)) {
    texts.push_back(read_text(*element, key));
  }
  return texts;
}

std::map<std::string, ParamValue> read_scalars(const TomlValue& value, std::string_view what) {
  const auto* table = std::get_if<TomlTable>(&value.data);
  if (table == nullptr) {
    throw ConfigError(value.place, fmt::format("{}: expected a table, {{key = value, …}}", what));
  }
  std::map<std::string, ParamValue> scalars;
  for (const TomlEntry& entry : table->entries) {
    scalars.emplace(entry.key, read_scalar(entry.value, entry.key));
  }
  return scalars;
}

const std::vector<TomlValue>& read_tables(const TomlEntry& entry) {
  const auto* tables = std::get_if<std::vector<TomlValue>>(&entry.value.data);
  if (tables == nullptr) {
    throw ConfigError(entry.value.place, fmt::format("{0}: expected tables that start with [[{0}]]", entry.key));
  }
  return *tables;
}

std::string key_path(const std::string& path) { return path + " key"; }

void note_places(std::map<std::string, SourcePlace>& places, const std::string& path, const TomlValue& value) {
  places.insert_or_assign(path, value.place);
  if (const auto* list = std::get_if<std::vector<TomlValue>>(&value.data)) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      note_places(places, fmt::format("{}[{}]", path, i), (*list)[i]);
    }
  } else if (const auto* table = std::get_if<TomlTable>(&value.data)) {
    for (const TomlEntry& entry : table->entries) {
      const std::string inner = fmt::format("{}.{}", path, entry.key);
      places.insert_or_assign(key_path(inner), entry.place);
      note_places(places, inner, entry.value);
    }
  }
}

}  // namespace textonbench
