#include "experiments/claims_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string_view>

#include "experiments/metrics/metric.h"
#include "experiments/toml_reader.h"

namespace textonbench {
namespace {

std::string read_choice(const TomlValue& value, std::string_view key, std::span<const std::string_view> choices) {
  std::string text = read_text(value, key);
  if (std::ranges::find(choices, text) == choices.end()) {
    throw ConfigError(value.place,
                      fmt::format("{}: expected one of {}; found \"{}\"", key, fmt::join(choices, ", "), text));
  }
  return text;
}

double read_limit(const TomlValue& value, std::string_view key) {
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&value.data)) return *real;
  throw ConfigError(value.place, fmt::format("{}: expected a number", key));
}

/// {below = x}, {above = x} or {within = [low, high]}.
ExpectedRange read_range(const TomlValue& value) {
  TableReader reader(value, "expect");
  const TomlEntry* below = reader.find("below");
  const TomlEntry* above = reader.find("above");
  const TomlEntry* within = reader.find("within");
  reader.refuse_unknown_keys();
  if ((below != nullptr) + (above != nullptr) + (within != nullptr) != 1) {
    throw ConfigError(value.place, "expect: exactly one of below, above and within is expected");
  }
  ExpectedRange range;
  if (below != nullptr) range.high = read_limit(below->value, "below");
  if (above != nullptr) range.low = read_limit(above->value, "above");
  if (within != nullptr) {
    const std::vector<TomlValue>& limits = read_list(within->value, "within");
    if (limits.size() != 2) {
      throw ConfigError(within->value.place,
                        fmt::format("within: expected [low, high], found a list of {}", limits.size()));
    }
    range = {read_limit(limits[0], "within"), read_limit(limits[1], "within")};
    if (range.low > range.high) {
      throw ConfigError(within->value.place, fmt::format("within: no number lies in [{}, {}]", range.low, range.high));
    }
  }
  return range;
}

ClaimSelection read_selection(const TomlEntry& entry) {
  const TomlValue& value = entry.value;
  TableReader reader(value, entry.key);
  ClaimSelection selection;
  selection.place = value.place;
  selection.run = read_identifier(reader.require("run").value, "run");
  const TomlValue& metric = reader.require("metric").value;
  selection.metric = read_identifier(metric, "metric");
  try {
    find_metric(selection.metric);
  } catch (const std::invalid_argument& error) {
    throw ConfigError(metric.place, error.what());
  }
  if (const TomlEntry* part = reader.find("part")) {
    constexpr std::array<std::string_view, 2> parts{"value", "floor"};
    selection.floor = read_choice(part->value, "part", parts) == "floor";
  }
  if (const TomlEntry* over_seeds = reader.find("over_seeds")) {
    constexpr std::array<std::string_view, 3> ways{"mean", "deviation", "least"};
    const std::string way = read_choice(over_seeds->value, "over_seeds", ways);
    selection.over_seeds = way == "mean"        ? OverSeeds::mean
                           : way == "deviation" ? OverSeeds::deviation
                                                : OverSeeds::least;
  }
  for (const TomlEntry& condition : std::get<TomlTable>(value.data).entries) {
    constexpr std::array<std::string_view, 4> own_keys{"run", "metric", "part", "over_seeds"};
    const bool own = std::ranges::find(own_keys, condition.key) != own_keys.end();
    selection.places.emplace(condition.key, own ? condition.value.place : condition.place);
    if (!own) selection.conditions.emplace(condition.key, read_scalar(condition.value, condition.key));
  }
  return selection;
}

ClaimTest read_test(TableReader& reader, const TomlEntry& config) {
  ClaimTest test;
  test.config = read_text(config.value, "config");
  test.config_place = config.value.place;
  test.measure = read_selection(reader.require("measure"));
  const TomlEntry* combine = reader.find("combine");
  if (const TomlEntry* against = reader.find("against")) {
    test.against = read_selection(*against);
    constexpr std::array<std::string_view, 2> ways{"difference", "ratio"};
    const std::string way = read_choice(reader.require("combine").value, "combine", ways);
    test.combine = way == "ratio" ? CombinePair::ratio : CombinePair::difference;
    if ((test.measure.over_seeds == OverSeeds::each) != (test.against->over_seeds == OverSeeds::each)) {
      throw ConfigError(against->place, "against: expected over_seeds in both of measure and against, or in neither");
    }
  } else if (combine != nullptr) {
    throw ConfigError(combine->place, "combine: there is nothing to combine with; expected the key \"against\" too");
  }
  test.expect = read_range(reader.require("expect").value);
  return test;
}

void check_need(const TomlValue& value, const std::string& need) {
  const std::string_view text = need;
  const bool named = text.starts_with("method:") || text.starts_with("metric:");
  if (text != "gpu" && (!named || text.ends_with(':'))) {
    throw ConfigError(value.place, fmt::format("needs: expected \"method:NAME\", \"metric:NAME\" or \"gpu\", found "
                                               "\"{}\"",
                                               need));
  }
}

Claim read_claim(const TomlValue& value, const std::string& paper) {
  TableReader reader(value, "[[claims]]");
  const auto text = [&](std::string_view key) { return read_text(reader.require(key).value, key); };
  const auto optional_text = [&](std::string_view key) {
    const TomlEntry* entry = reader.find(key);
    return entry == nullptr ? std::string() : read_text(entry->value, key);
  };
  Claim claim;
  claim.paper = paper;
  const TomlEntry& id = reader.require("id");
  claim.place = id.value.place;
  claim.id = read_identifier(id.value, "id");
  claim.where = text("where");
  claim.statement = text("statement");
  constexpr std::array<std::string_view, 5> kinds{"identity", "quantitative", "ordinal", "timing", "setting"};
  claim.kind = read_choice(reader.require("kind").value, "kind", kinds);
  claim.paper_value = text("paper_value");
  claim.how = text("how");
  claim.caveat = optional_text("caveat");
  claim.note = optional_text("note");
  if (const TomlEntry* needs = reader.find("needs")) {
    for (const TomlValue& need : read_list(needs->value, "needs")) {
      claim.needs.push_back(read_text(need, "needs"));
      check_need(need, claim.needs.back());
    }
  }
  if (const TomlEntry* config = reader.find("config")) {
    claim.test = read_test(reader, *config);
  } else {
    for (const std::string_view key : {"measure", "against", "combine", "expect"}) {
      if (const TomlEntry* entry = reader.find(key)) {
        throw ConfigError(entry->place, fmt::format("{}: a test also has the key \"config\"", key));
      }
    }
  }
  reader.refuse_unknown_keys();
  if (!claim.test && claim.needs.empty()) {
    throw ConfigError(claim.place,
                      fmt::format("claim {} has neither a test (config, measure, expect) nor needs", claim.id));
  }
  return claim;
}

}  // namespace

std::vector<Claim> read_claims(std::span<const std::filesystem::path> files) {
  std::vector<Claim> claims;
  std::map<std::string, SourcePlace> places;
  for (const std::filesystem::path& file : files) {
    const TomlValue root = read_toml(file);
    TableReader reader(root, "the claims file");
    const std::string paper = read_text(reader.require("paper").value, "paper");
    for (const TomlValue& value : read_tables(reader.require("claims"))) {
      claims.push_back(read_claim(value, paper));
      const Claim& claim = claims.back();
      if (const auto [first, is_new] = places.emplace(claim.id, claim.place); !is_new) {
        throw ConfigError(claim.place, fmt::format("a second claim has the id \"{}\"; the first is at {}:{}", claim.id,
                                                   first->second.file, first->second.line));
      }
    }
    reader.refuse_unknown_keys();
  }
  return claims;
}

}  // namespace textonbench
