#include "paper_figures/frame_table_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "paper_figures/number_format.h"

namespace textonbench {
namespace {

constexpr const char* nothing = "–";

std::size_t code_points(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// So many columns to the left, the others to the right.
std::string aligned(const std::vector<std::vector<std::string>>& lines, std::size_t left) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const std::vector<std::string>& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], code_points(line[c]));
  }
  std::string text;
  for (const std::vector<std::string>& line : lines) {
    std::string row;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const std::string padding(widths[c] - code_points(line[c]), ' ');
      row += fmt::format("{}{}  ", c < left ? line[c] : padding, c < left ? padding : line[c]);
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

/// Whether software drew every row that has numbers.
bool is_of_software(const FrameTable& table) {
  return std::ranges::any_of(table.rows, &FrameRow::software) &&
         std::ranges::all_of(table.rows, [](const FrameRow& row) { return row.software || !row.numbers; });
}

/// What a row of the terminal's table begins with.
std::vector<std::string> head_of_row(const FrameRow& row, bool names_renderer, bool counts_runs) {
  std::vector<std::string> head{row.label};
  if (names_renderer) head.push_back(row.numbers ? row.renderer : nothing);
  if (counts_runs) head.push_back(row.numbers ? std::to_string(row.runs) : nothing);
  return head;
}

}  // namespace

std::vector<std::string> renderers_of(const FrameTable& table) {
  std::set<std::string> renderers;
  for (const FrameRow& row : table.rows) {
    if (row.numbers) renderers.insert(row.renderer);
  }
  return {renderers.begin(), renderers.end()};
}

std::vector<std::string> frame_columns(const FrameTable& table) {
  return {"ms", "5 – 95 %", is_of_software(table) ? "software fps" : "fps", "ns/pixel", "Gfetch/s", "of ceiling"};
}

std::vector<std::string> frame_cells(const FrameRow& row, const FrameTable& table) {
  if (!row.numbers) return {nothing, nothing, nothing, nothing, nothing, nothing};
  const FrameNumbers& n = *row.numbers;
  return {format_number(n.milliseconds),
          fmt::format("{} – {}", format_number(n.p05), format_number(n.p95)),
          format_number(n.frames_per_second) + (row.software && !is_of_software(table) ? " in software" : ""),
          format_number(n.ns_per_pixel),
          format_number(1e-9 * n.fetches_per_second, 3),
          n.ceiling_fraction > 0 ? format_number(n.ceiling_fraction, 2) : nothing};
}

std::string shared_obstacle(const FrameTable& table) {
  const std::string& first = table.rows.front().obstacle;
  const bool shared = std::ranges::all_of(
      table.rows, [&](const FrameRow& row) { return !row.numbers.has_value() && row.obstacle == first; });
  return shared ? first : "";
}

std::string paper_machine(const FigureInput& input) {
  const auto machine = input.table.options.find("paper_machine");
  return machine == input.table.options.end() ? "the paper" : to_string(machine->second);
}

std::vector<std::string> paper_columns() { return {"ms", "fps", "ns/pixel"}; }

std::vector<std::string> paper_cells(const FrameRow& row) {
  if (!row.paper_milliseconds) return {nothing, nothing, nothing};
  return {format_number(*row.paper_milliseconds, 3), format_number(1e3 / *row.paper_milliseconds, 3),
          row.paper_ns_per_pixel ? format_number(*row.paper_ns_per_pixel, 3) : nothing};
}

std::string frame_table_text(const FigureInput& input) {
  const FrameTable table = fill_frame_table(input);
  std::string text = input.table.title + "\n";
  if (const std::string shared = shared_obstacle(table); !shared.empty()) return fmt::format("{}  {}\n", text, shared);
  const std::vector<std::string> renderers = renderers_of(table);
  const bool names_renderer = renderers.size() > 1;
  const bool counts_runs = std::ranges::any_of(table.rows, [](const FrameRow& row) { return row.runs > 1; });
  for (const std::string& renderer : renderers) text += renderer + "\n";
  const bool any_paper =
      std::ranges::any_of(table.rows, [](const FrameRow& row) { return row.paper_milliseconds.has_value(); });
  if (any_paper && input.table.options.contains("paper_machine"))
    text += fmt::format("paper: {}\n", paper_machine(input));
  std::vector<std::vector<std::string>> lines{{""}};
  if (names_renderer) lines.front().emplace_back("drawn by");
  if (counts_runs) lines.front().emplace_back("runs");
  const auto extend = [](std::vector<std::string>& line, const std::vector<std::string>& more) {
    line.insert(line.end(), more.begin(), more.end());
  };
  extend(lines.front(), frame_columns(table));
  if (any_paper) {
    for (const std::string& column : paper_columns()) lines.front().push_back("paper " + column);
  }
  for (const FrameRow& row : table.rows) {
    std::vector<std::string> line = head_of_row(row, names_renderer, counts_runs);
    extend(line, frame_cells(row, table));
    if (any_paper) extend(line, paper_cells(row));
    lines.push_back(std::move(line));
  }
  text += aligned(lines, names_renderer ? 2 : 1);
  for (const FrameRow& row : table.rows) {
    if (!row.obstacle.empty()) text += fmt::format("{}: {}\n", row.label, row.obstacle);
  }
  if (table.ratios.empty()) return text;
  lines = {{"ratio", "here", "paper"}};
  for (const FrameRatio& ratio : table.ratios) {
    lines.push_back({ratio.label, ratio.value ? format_number(*ratio.value, 3) : nothing,
                     ratio.paper ? format_number(*ratio.paper, 3) : nothing});
  }
  return text + aligned(lines, 1);
}

}  // namespace textonbench
