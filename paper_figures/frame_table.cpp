#include "paper_figures/frame_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "experiments/files.h"
#include "paper_figures/frame_table_text.h"
#include "paper_figures/number_format.h"
#include "paper_figures/table.h"
#include "paper_figures/templates.h"

namespace textonbench {
namespace {

using FrameJson = nlohmann::ordered_json;
using FrameKeys = std::map<std::string, ParamValue>;

constexpr std::array<std::string_view, 3> own_keys{"run", "label", "paper_ms"};

std::optional<double> positive_number(const FigureTable& table, const std::string& list, std::size_t index,
                                      const FrameKeys& keys, const std::string& key) {
  const auto found = keys.find(key);
  if (found == keys.end()) return std::nullopt;
  const auto* whole = std::get_if<std::int64_t>(&found->second);
  const auto* real = std::get_if<double>(&found->second);
  const double value = whole != nullptr ? static_cast<double>(*whole) : real != nullptr ? *real : 0;
  if (!(value > 0) || !std::isfinite(value)) {
    throw ConfigError(place_of(table, fmt::format("{}[{}].{}", list, index, key)),
                      fmt::format("{} = {}: expected a finite number above 0", key, to_string(found->second)));
  }
  return value;
}

const std::vector<FrameKeys>& tables_of(const FigureTable& table, const std::string& list) {
  static const std::vector<FrameKeys> none;
  const auto found = table.lists.find(list);
  return found == table.lists.end() ? none : found->second;
}

bool serves(const SelectedRun& run, const FrameKeys& row) {
  if (run.label != to_string(row.at("run"))) return false;
  return std::ranges::all_of(row, [&](const auto& entry) {
    return std::ranges::find(own_keys, entry.first) != own_keys.end() ||
           attribute_of(run.spec(), entry.first) == to_string(entry.second);
  });
}

/// A number under nested keys of a record that another program may have written, or 0.
double timed_number(const Record& timing, const char* key) {
  const auto found = timing.find(key);
  return found != timing.end() && found->is_number() ? found->get<double>() : 0;
}

std::string renderer_of(const Record& record, bool& software) {
  const Record gpu = record.value("provenance", Record::object()).value("gpu", Record::object());
  const bool is_software = gpu.value("software", false);
  software = software || is_software;
  return gpu.value("renderer", std::string("unknown")) + (is_software ? " [software]" : "");
}

FrameRow fill_row(const FigureInput& input, const FrameKeys& keys, std::size_t index) {
  FrameRow row;
  row.label = to_string(keys.at("label"));
  row.paper_milliseconds = positive_number(input.table, "rows", index, keys, "paper_ms");
  FrameNumbers sums;
  std::set<std::string> renderers, obstacles;
  for (const SelectedRun& run : input.runs) {
    if (!serves(run, keys)) continue;
    if (row.record.empty()) row.record = run.planned->id;
    if (row.paper_milliseconds && run.spec().size.area() > 0) {
      row.paper_ns_per_pixel = 1e6 * *row.paper_milliseconds / static_cast<double>(run.spec().size.area());
    }
    const Record timing = run.ok() ? run.record->value("timing", Record::object()) : Record::object();
    const Record ms = timing.value("ms", Record::object());
    if (timed_number(ms, "median") <= 0) {
      obstacles.insert(run.ok() ? "its record holds no times of frames" : run.reason());
      continue;
    }
    renderers.insert(renderer_of(*run.record, row.software));
    sums.milliseconds += timed_number(ms, "median");
    sums.p05 += timed_number(ms, "p05");
    sums.p95 += timed_number(ms, "p95");
    sums.ns_per_pixel += timed_number(timing, "ns_per_pixel");
    sums.fetches_per_second += timed_number(timing, "fetches_per_second");
    sums.ceiling_fraction += timed_number(timing, "fetch_ceiling_fraction");
    ++row.runs;
  }
  row.renderer = fmt::format("{}", fmt::join(renderers, ", "));
  row.obstacle = row.record.empty() ? "no run in this plan" : fmt::format("{}", fmt::join(obstacles, "; "));
  if (row.runs > 0) {
    const double share = 1 / static_cast<double>(row.runs);
    row.numbers = {.milliseconds = share * sums.milliseconds,
                   .p05 = share * sums.p05,
                   .p95 = share * sums.p95,
                   .frames_per_second = 1e3 / (share * sums.milliseconds),
                   .ns_per_pixel = share * sums.ns_per_pixel,
                   .fetches_per_second = share * sums.fetches_per_second,
                   .ceiling_fraction = share * sums.ceiling_fraction};
  }
  return row;
}

const FrameRow& row_named(const FigureInput& input, const FrameTable& table, std::size_t ratio, const FrameKeys& keys,
                          const std::string& key) {
  const std::string name = to_string(keys.at(key));
  const auto found = std::ranges::find(table.rows, name, &FrameRow::label);
  if (found != table.rows.end()) return *found;
  std::vector<std::string_view> labels;
  for (const FrameRow& row : table.rows) labels.emplace_back(row.label);
  throw ConfigError(place_of(input.table, fmt::format("ratios[{}].{}", ratio, key)),
                    fmt::format("no row has the label \"{}\"{}", name, did_you_mean(name, labels)));
}

/// Throws unless the runs of a row are the same but for exemplar and seed: a mean over textons of several sizes, say,
/// would pass for one of them.
void require_like_runs(const FigureInput& input, std::size_t index, const std::vector<std::string_view>& attributes) {
  const FrameKeys& row = tables_of(input.table, "rows")[index];
  const RunSpec* first = nullptr;
  std::set<std::string_view> differing;
  for (const SelectedRun& run : input.runs) {
    if (!serves(run, row)) continue;
    if (first == nullptr) first = &run.spec();
    for (const std::string_view name : attributes) {
      const std::string key(name);
      if (attribute_of(run.spec(), key) != attribute_of(*first, key)) differing.insert(name);
    }
  }
  if (differing.empty()) return;
  throw ConfigError(place_of(input.table, fmt::format("rows[{}]", index)),
                    fmt::format("row \"{}\" matches runs that differ in {}: add {}", to_string(row.at("label")),
                                fmt::join(differing, ", "), fmt::join(differing, " or ")));
}

std::string number_text(const std::optional<double>& value, int digits) {
  return value ? format_number(*value, digits) : "–";
}

FrameJson frame_table_view(const FigureInput& input, bool linked) {
  const FrameTable table = fill_frame_table(input);
  FrameJson rows = FrameJson::array(), ratios = FrameJson::array();
  bool any_paper = false, any_ratio_of_paper = false;
  const std::string shared = shared_obstacle(table);
  for (const FrameRow& row : table.rows) {
    any_paper = any_paper || row.paper_milliseconds.has_value();
    // The range stands below its median.
    const std::vector<std::string> texts = frame_cells(row, table);
    FrameJson cells = {{{"value", texts[0]}, {"detail", row.numbers ? FrameJson(texts[1]) : FrameJson(nullptr)}}};
    for (std::size_t c = 2; c < texts.size(); ++c) cells.push_back({{"value", texts[c]}, {"detail", nullptr}});
    rows.push_back({{"label", row.label},
                    {"renderer", or_null(row.renderer)},
                    {"extent", row.runs > 1 ? FrameJson(fmt::format("mean of {} runs", row.runs)) : FrameJson(nullptr)},
                    {"obstacle", shared.empty() ? or_null(row.obstacle) : FrameJson(nullptr)},
                    {"record", row.record},
                    {"linked", linked && !row.record.empty()},
                    {"cells", std::move(cells)},
                    {"paper", paper_cells(row)}});
  }
  for (const FrameRatio& ratio : table.ratios) {
    any_ratio_of_paper = any_ratio_of_paper || ratio.paper.has_value();
    ratios.push_back(
        {{"label", ratio.label}, {"value", number_text(ratio.value, 3)}, {"paper", {number_text(ratio.paper, 3)}}});
  }
  if (!any_paper) {
    for (FrameJson& row : rows) row["paper"] = FrameJson::array();
  }
  if (!any_ratio_of_paper) {
    for (FrameJson& ratio : ratios) ratio["paper"] = FrameJson::array();
  }
  std::vector<std::string> columns = frame_columns(table);
  columns.erase(columns.begin() + 1);
  const std::vector<std::string> renderers = renderers_of(table);
  return {{"caption", input.table.title},
          {"obstacle", or_null(shared)},
          {"columns", std::move(columns)},
          {"papers", any_paper ? FrameJson(paper_columns()) : FrameJson::array()},
          {"renderer", renderers.size() == 1 ? renderers.front() : "here"},
          {"paper_machine", paper_machine(input)},
          {"has_papers", any_paper},
          {"rows", std::move(rows)},
          {"has_ratios", !ratios.empty()},
          {"has_paper_ratios", any_ratio_of_paper},
          {"ratios", std::move(ratios)}};
}

std::string frames_csv(const FrameTable& table) {
  std::string csv =
      "row,renderer,software,runs,ms,p05_ms,p95_ms,frames_per_second,ns_per_pixel,fetches_per_second,"
      "fetch_ceiling_fraction,paper_ms,paper_ns_per_pixel,obstacle\r\n";
  const auto exact = [](const std::optional<double>& value) { return value ? format_exact(*value) : ""; };
  for (const FrameRow& row : table.rows) {
    csv += fmt::format("{},{},{},{}", csv_field(row.label), csv_field(row.renderer), row.software, row.runs);
    const FrameNumbers n = row.numbers.value_or(FrameNumbers{});
    for (const double value : {n.milliseconds, n.p05, n.p95, n.frames_per_second, n.ns_per_pixel, n.fetches_per_second,
                               n.ceiling_fraction}) {
      csv += fmt::format(",{}", row.numbers ? format_exact(value) : "");
    }
    csv += fmt::format(",{},{},{}\r\n", exact(row.paper_milliseconds), exact(row.paper_ns_per_pixel),
                       csv_field(row.obstacle));
  }
  return csv;
}

std::string ratios_csv(const FrameTable& table) {
  std::string csv = "ratio,value,paper\r\n";
  const auto exact = [](const std::optional<double>& value) { return value ? format_exact(*value) : ""; };
  for (const FrameRatio& ratio : table.ratios) {
    csv += fmt::format("{},{},{}\r\n", csv_field(ratio.label), exact(ratio.value), exact(ratio.paper));
  }
  return csv;
}

}  // namespace

FrameTable fill_frame_table(const FigureInput& input) {
  FrameTable table;
  const std::vector<FrameKeys>& rows = tables_of(input.table, "rows");
  for (std::size_t i = 0; i < rows.size(); ++i) table.rows.push_back(fill_row(input, rows[i], i));
  const std::vector<FrameKeys>& ratios = tables_of(input.table, "ratios");
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    const FrameRow& of = row_named(input, table, i, ratios[i], "of");
    const FrameRow& over = row_named(input, table, i, ratios[i], "over");
    FrameRatio ratio{.label = to_string(ratios[i].at("label")),
                     .value = std::nullopt,
                     .paper = positive_number(input.table, "ratios", i, ratios[i], "paper")};
    const bool comparable = of.numbers && over.numbers && of.renderer == over.renderer;
    if (comparable) ratio.value = of.numbers->ns_per_pixel / over.numbers->ns_per_pixel;
    table.ratios.push_back(std::move(ratio));
  }
  return table;
}

void check_frame_table(const FigureInput& input) {
  require_known_keys(input.table, {"paper_machine"}, {"rows", "ratios"}, {});
  if (tables_of(input.table, "rows").empty()) {
    throw ConfigError(input.table.place,
                      fmt::format("frame_table \"{}\" needs rows = [{{run = …, label = …}}]", input.table.name));
  }
  std::set<std::string> options;
  for (const SelectedRun& run : input.runs) {
    for (const auto& [name, value] : options_of(run.spec())) options.insert(name);
  }
  std::vector<std::string_view> attributes{"method", "width", "height"};
  attributes.insert(attributes.end(), options.begin(), options.end());
  constexpr std::array<std::string_view, 2> of_row{"run", "label"};
  std::vector<std::string_view> selectors{"paper_ms", "exemplar", "seed"};
  selectors.insert(selectors.end(), attributes.begin(), attributes.end());
  if (input.runs.empty()) {  // a plan whose exemplars are all elsewhere knows no options
    for (const FrameKeys& row : tables_of(input.table, "rows")) {
      for (const auto& [key, value] : row) selectors.emplace_back(key);
    }
  }
  require_known_columns(input.table, "rows", of_row, selectors);
  constexpr std::array<std::string_view, 3> of_ratio{"label", "of", "over"};
  constexpr std::array<std::string_view, 1> paper{"paper"};
  require_known_columns(input.table, "ratios", of_ratio, paper);
  const FrameTable table = fill_frame_table(input);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    require_like_runs(input, i, attributes);
    const std::string& label = table.rows[i].label;
    if (std::ranges::find(table.rows, label, &FrameRow::label) != table.rows.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw ConfigError(place_of(input.table, fmt::format("rows[{}].label", i)),
                        fmt::format("two rows have the label \"{}\": expected one each", label));
    }
  }
}

std::vector<std::filesystem::path> write_frame_table(const FigureInput& input, const ResultsFolder& /*results*/,
                                                     const std::filesystem::path& stem) {
  const FrameTable table = fill_frame_table(input);
  std::vector<std::filesystem::path> files{with_suffix(stem, ".csv"), with_suffix(stem, "_ratios.csv"),
                                           with_suffix(stem, ".html")};
  write_atomically(files[0], frames_csv(table));
  write_atomically(files[1], ratios_csv(table));
  write_atomically(files[2], render_template("frame_table", frame_table_view(input, false)));
  return files;
}

std::string frame_table_html(const FigureInput& input, PictureStore& /*pictures*/,
                             const std::filesystem::path& /*stem*/) {
  return render_template("frame_table", frame_table_view(input, true));
}

}  // namespace textonbench
