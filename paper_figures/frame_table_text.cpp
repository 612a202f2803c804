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

/// The first column to the left, the others to the right.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size());
  for (const std::vector<std::string>& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], code_points(line[c]));
  }
  std::string text;
  for (const std::vector<std::string>& line : lines) {
    std::string row;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const std::string padding(widths[c] - code_points(line[c]), ' ');
      row += c == 0 ? line[c] + padding : fmt::format("  {}{}", padding, line[c]);
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

}  // namespace

std::vector<std::string> frame_columns(const FrameTable& table) {
  const bool software = std::ranges::any_of(table.rows, &FrameRow::software);
  return {"ms", "5 – 95 %", software ? "software fps" : "fps", "ns/pixel", "Gfetch/s", "of ceiling"};
}

std::vector<std::string> frame_cells(const FrameRow& row) {
  if (!row.numbers) return {nothing, nothing, nothing, nothing, nothing, nothing};
  const FrameNumbers& n = *row.numbers;
  return {format_number(n.milliseconds),
          fmt::format("{} – {}", format_number(n.p05), format_number(n.p95)),
          format_number(n.frames_per_second),
          format_number(n.ns_per_pixel),
          format_number(1e-9 * n.fetches_per_second, 3),
          format_number(n.ceiling_fraction, 2)};
}

std::string shared_obstacle(const FrameTable& table) {
  const std::string& first = table.rows.front().obstacle;
  const bool shared = std::ranges::all_of(
      table.rows, [&](const FrameRow& row) { return !row.numbers.has_value() && row.obstacle == first; });
  return shared ? first : "";
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
  std::set<std::string> renderers;
  for (const FrameRow& row : table.rows) {
    if (row.numbers) renderers.insert(row.renderer);
  }
  for (const std::string& renderer : renderers) text += renderer + "\n";
  const bool any_paper =
      std::ranges::any_of(table.rows, [](const FrameRow& row) { return row.paper_milliseconds.has_value(); });
  std::vector<std::vector<std::string>> lines{{""}};
  const auto extend = [](std::vector<std::string>& line, const std::vector<std::string>& more) {
    line.insert(line.end(), more.begin(), more.end());
  };
  extend(lines.front(), frame_columns(table));
  if (any_paper) {
    for (const std::string& column : paper_columns()) lines.front().push_back("paper " + column);
  }
  for (const FrameRow& row : table.rows) {
    std::vector<std::string> line{row.label};
    extend(line, frame_cells(row));
    if (any_paper) extend(line, paper_cells(row));
    lines.push_back(std::move(line));
  }
  text += aligned(lines);
  for (const FrameRow& row : table.rows) {
    if (!row.obstacle.empty()) text += fmt::format("{}: {}\n", row.label, row.obstacle);
  }
  if (table.ratios.empty()) return text;
  lines = {{"ratio", "here", "paper"}};
  for (const FrameRatio& ratio : table.ratios) {
    lines.push_back({ratio.label, ratio.value ? format_number(*ratio.value, 3) : nothing,
                     ratio.paper ? format_number(*ratio.paper, 3) : nothing});
  }
  return text + aligned(lines);
}

}  // namespace textonbench
