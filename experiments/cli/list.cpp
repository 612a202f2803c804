#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/cli/table.h"
#include "experiments/ledger.h"
#include "experiments/metrics/metric.h"
#include "experiments/provenance.h"
#include "methods/base/image_io.h"

namespace textonbench::cli {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const ParamValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

void list_methods(bool json) {
  Json methods = Json::array();
  for (const MethodEntry& method : method_catalog()) {
    Json params = Json::array();
    for (const ParamSpec& param : method.params) {
      params.push_back({{"name", param.name},
                        {"default", to_json(param.default_value)},
                        {"unit", param.unit},
                        {"help", param.help},
                        {"choices", param.choices}});
    }
    methods.push_back(
        {{"name", method.name}, {"title", method.title}, {"reference", method.reference}, {"params", params}});
  }
  if (json) return print_json({{"methods", methods}});
  for (const MethodEntry& method : method_catalog()) {
    fmt::print("{}  {}\n    {}\n", method.name, method.title, method.reference);
    for (const ParamSpec& param : method.params) {
      const std::string choices =
          param.choices.empty() ? std::string() : fmt::format(" ({})", fmt::join(param.choices, "|"));
      fmt::print("    -p {}={}{}{}  {}{}\n", param.name, to_string(param.default_value), param.unit.empty() ? "" : " ",
                 param.unit, param.help, choices);
    }
  }
}

const char* level_name(MetricLevel level) {
  switch (level) {
    case MetricLevel::model:
      return "model";
    case MetricLevel::sample:
      return "sample";
    case MetricLevel::frame:
      return "frame";
    case MetricLevel::cost:
      return "cost";
  }
  return "";
}

const char* better_name(Better better) {
  switch (better) {
    case Better::lower:
      return "lower";
    case Better::higher:
      return "higher";
    case Better::nearer_zero:
      return "nearer zero";
    case Better::neither:
      return "neither";
  }
  return "";
}

void list_metrics(bool json) {
  Json metrics = Json::array();
  std::vector<std::vector<std::string>> rows;
  for (const MetricEntry& metric : metric_catalog()) {
    metrics.push_back({{"name", metric.name},
                       {"title", metric.title},
                       {"unit", metric.unit},
                       {"level", level_name(metric.level)},
                       {"better", better_name(metric.better)},
                       {"identity", metric.identity},
                       {"reference", metric.reference}});
    rows.push_back({std::string(metric.name), level_name(metric.level), std::string(metric.unit),
                    better_name(metric.better), std::string(metric.title)});
  }
  if (json) return print_json({{"metrics", metrics}});
  print_table({{"METRIC"}, {"LEVEL"}, {"UNIT"}, {"BETTER"}, {"WHAT"}}, rows);
}

/// Size and channels of an exemplar that is here. A procedural one and a stack have no file to ask.
ImageInfo image_info(const ExemplarInfo& info) {
  if (!info.file.empty()) return read_image_info(info.file);
  const Image pixels = load_exemplar(info).pixels;
  return {.extent = pixels.extent(), .channels = pixels.channels()};
}

/// What --json tells of one; why a file that is here cannot be used stands under "reason".
Json describe(const ExemplarInfo& info) {
  Json entry = {{"name", info.name},     {"available", info.available}, {"width", nullptr},
                {"height", nullptr},     {"channels", nullptr},         {"sha256", nullptr},
                {"source", info.source}, {"licence", info.licence},     {"tags", info.tags}};
  if (!info.available) {
    entry["how_to_get"] = info.how_to_get;
    return entry;
  }
  try {
    const ImageInfo image = image_info(info);
    entry["sha256"] = exemplar_sha256(info);
    entry["width"] = image.extent.width;
    entry["height"] = image.extent.height;
    entry["channels"] = image.channels;
  } catch (const std::invalid_argument& error) {
    // One bad file must not hide the others.
    entry["available"] = false;
    entry["reason"] = error.what();
  }
  return entry;
}

void list_exemplars(bool json) {
  Json exemplars = Json::array();
  const ExemplarCatalog catalog(home_folder());
  for (const ExemplarInfo& info : catalog.all()) exemplars.push_back(describe(info));
  if (json) return print_json({{"exemplars", exemplars}});

  std::vector<std::vector<std::string>> rows;
  std::map<std::string, std::vector<std::string>> missing;  // names by the way to get them
  for (const Json& e : exemplars) {
    const auto text = [&e](const char* key) { return e[key].get<std::string>(); };
    if (e["available"]) {
      rows.push_back({text("name"), fmt::format("{}x{}", e["width"].get<int>(), e["height"].get<int>()),
                      std::to_string(e["channels"].get<int>()), text("sha256").substr(0, 12), text("licence"),
                      text("source")});
    } else {
      missing[e.contains("reason") ? "unusable: " + text("reason") : text("how_to_get")].push_back(text("name"));
    }
  }
  print_table({{"EXEMPLAR"}, {"SIZE", Align::right}, {"CHANNELS", Align::right}, {"SHA-256"}, {"LICENCE"}, {"SOURCE"}},
              rows);
  for (const auto& [how, names] : missing) {
    fmt::print("\nNot here ({}):\n", how);
    for (const std::string& name : names) fmt::print("  {}\n", name);
  }
}

void list_configs(bool json) {
  Json configs = Json::array();
  std::vector<std::vector<std::string>> rows;
  for (const std::filesystem::path& file : all_configs(home_folder())) {
    const Config config = read_config(file, Profile::quick);
    configs.push_back(
        {{"name", config.name}, {"title", config.title}, {"source", config.source}, {"file", file.string()}});
    rows.push_back({config.name, config.title, config.source});
  }
  if (json) return print_json({{"configs", configs}});
  print_table({{"CONFIG"}, {"TITLE"}, {"SOURCE"}}, rows);
}

void list_claims(bool json) {
  const std::filesystem::path home = home_folder();
  const Ledger ledger = read_ledger(home, ExemplarCatalog(home), Profile::quick);
  Json claims = Json::array();
  std::vector<std::vector<std::string>> rows;
  for (const Claim& claim : ledger.claims) {
    const std::string config = claim.test ? claim.test->config : "";
    claims.push_back({{"id", claim.id},
                      {"paper", claim.paper},
                      {"where", claim.where},
                      {"statement", claim.statement},
                      {"kind", claim.kind},
                      {"paper_value", claim.paper_value},
                      {"how", claim.how},
                      {"caveat", claim.caveat},
                      {"note", claim.note},
                      {"needs", claim.needs},
                      {"config", config}});
    rows.push_back({claim.id, claim.paper, claim.kind,
                    config.empty() ? fmt::format("{}", fmt::join(claim.needs, ", ")) : config, claim.statement});
  }
  if (json) return print_json({{"claims", claims}});
  print_table({{"ID"}, {"PAPER"}, {"KIND"}, {"CONFIG OR NEEDS"}, {"CLAIM"}}, rows);
}

}  // namespace

Command list_command(CLI::App& app, const GlobalOptions&) {
  struct Options {
    std::string what;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* list = app.add_subcommand("list", "Tell what there is: methods, metrics, exemplars, configs or claims");
  list->add_option("WHAT", options->what, "methods, metrics, exemplars, configs or claims")
      ->required()
      ->check(CLI::IsMember({"methods", "metrics", "exemplars", "configs", "claims"}));
  list->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*list, "  textonbench list exemplars");
  return {list, [options] {
            if (options->what == "methods") list_methods(options->json);
            if (options->what == "metrics") list_metrics(options->json);
            if (options->what == "exemplars") list_exemplars(options->json);
            if (options->what == "configs") list_configs(options->json);
            if (options->what == "claims") list_claims(options->json);
            return 0;
          }};
}

}  // namespace textonbench::cli
