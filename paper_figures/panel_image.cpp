#include "paper_figures/panel_image.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "experiments/provenance.h"
#include "methods/base/image_io.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

constexpr float paper = 1.0F;
constexpr float ink = 0.1F;
constexpr float empty_cell = 0.93F;
constexpr float quiet_ink = 0.35F;

void fill(Image& image, int x, int y, Extent extent, float value) {
  for (int c = 0; c < image.channels(); ++c) {
    for (int row = y; row < y + extent.height; ++row) {
      std::ranges::fill(image.row(c, row).subspan(static_cast<std::size_t>(x), static_cast<std::size_t>(extent.width)),
                        value);
    }
  }
}

/// Copies a picture of one or three channels onto the sheet.
void paste(Image& sheet, const Image& picture, int x, int y) {
  for (int c = 0; c < sheet.channels(); ++c) {
    for (int row = 0; row < picture.height(); ++row) {
      std::ranges::copy(picture.row(std::min(c, picture.channels() - 1), row), sheet.row(c, y + row).begin() + x);
    }
  }
}

/// Turned a quarter counter-clockwise, so that text reads upward.
Image turned(const Image& image) {
  Image result({image.height(), image.width()}, image.channels());
  for (int c = 0; c < image.channels(); ++c) {
    for (int y = 0; y < result.height(); ++y) {
      for (int x = 0; x < result.width(); ++x) result.at(c, x, y) = image.at(c, image.width() - 1 - y, x);
    }
  }
  return result;
}

/// Drops the last character of UTF-8 text.
void drop_last_character(std::string& text) {
  while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) text.pop_back();
  if (!text.empty()) text.pop_back();
}

/// OpenImageIO draws the characters of Latin-1 only, so the ellipsis is three periods.
std::string shortened(std::string text, int font, int width) {
  if (text_extent(text, font).width <= width) return text;
  while (!text.empty() && text_extent(text + "...", font).width > width) drop_last_character(text);
  return text + "...";
}

std::vector<std::string> wrapped(const std::string& text, int font, int width) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.empty() && text_extent(lines.back() + " " + word, font).width <= width) {
      lines.back() += " " + word;
    } else {
      lines.push_back(shortened(word, font, width));
    }
  }
  return lines;
}

/// A strip with the text in its middle.
Image caption(const std::string& text, int font, Extent extent) {
  Image strip(extent, 3);
  fill(strip, 0, 0, extent, paper);
  const std::string shown = shortened(text, font, extent.width);
  const int x = (extent.width - text_extent(shown, font).width) / 2;
  draw_text(strip, std::max(x, 0), (extent.height + font * 7 / 10) / 2, shown, font, ink);
  return strip;
}

Image reason_picture(const std::string& reason, int side, int font) {
  Image picture({side, side}, 1);
  fill(picture, 0, 0, picture.extent(), empty_cell);
  const int line_height = font * 13 / 10;
  const int inset = font / 2;
  const auto most_lines = static_cast<std::size_t>(std::max(1, (side - 2 * inset) / line_height));
  std::vector<std::string> lines = wrapped(reason, font, side - 2 * inset);
  if (lines.size() > most_lines) {
    lines.resize(most_lines);
    lines.back() = shortened(lines.back() + " ...", font, side - 2 * inset);
  }
  int baseline = inset + font;
  for (const std::string& line : lines) {
    draw_text(picture, inset, baseline, line, font, quiet_ink);
    baseline += line_height;
  }
  return picture;
}

/// What fills a cell, at most `side` pixels wide and high.
Image cell_picture(const PanelCell& cell, int side, int font, const ResultsFolder& results) {
  if (!cell.picture) return reason_picture(cell.absent, side, font);
  const std::filesystem::path file = results.path() / cell.picture->value("file", std::string());
  if (!std::filesystem::is_regular_file(file)) return reason_picture(std::string(lost_picture), side, font);
  const Image picture = shown_picture(read_image(file).image, side, cell.fit);
  const int factor = side / std::max(picture.width(), picture.height());
  return factor > 1 ? resize(picture, {picture.width() * factor, picture.height() * factor}) : picture;
}

}  // namespace

PanelGeometry panel_geometry(const PanelLayout& layout, int cell) {
  const int font = std::clamp(cell / 14, 10, 40);
  return {.cell = cell,
          .gap = std::max(4, cell / 40),
          .margin = std::max(4, cell / 24),
          .font = font,
          .header = font * 9 / 5,
          .footer = layout.has_notes() ? font * 9 / 5 : 0,
          .rows = static_cast<int>(layout.rows.size()),
          .columns = static_cast<int>(layout.columns.size())};
}

std::string panel_digest(const PanelLayout& layout, int cell, const ResultsFolder& results) {
  static const std::string program = sha256_of_file("/proc/self/exe");
  nlohmann::ordered_json inputs{program, cell, layout.columns};
  for (const PanelRow& row : layout.rows) {
    inputs.push_back(row.exemplar);
    for (const PanelCell& contents : row.cells) {
      const std::string file = contents.picture ? contents.picture->value("file", std::string()) : "";
      const bool is_here = contents.picture && std::filesystem::is_regular_file(results.path() / file);
      inputs.push_back({file, is_here, contents.fit == PictureFit::whole, contents.absent, contents.note});
    }
  }
  return sha256(inputs.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

Image draw_panel(const PanelLayout& layout, int cell, const ResultsFolder& results) {
  const PanelGeometry g = panel_geometry(layout, cell);
  Image sheet(g.extent(), 3);
  fill(sheet, 0, 0, g.extent(), paper);
  const Extent strip{cell, g.header};
  for (int column = 0; column < g.columns; ++column) {
    paste(sheet, caption(layout.columns[static_cast<std::size_t>(column)], g.font, strip), g.left(column), g.margin);
  }
  for (int row = 0; row < g.rows; ++row) {
    const std::string& exemplar = layout.rows[static_cast<std::size_t>(row)].exemplar;
    paste(sheet, turned(caption(exemplar, g.font, strip)), g.margin, g.top(row));
  }
  parallel_for(g.rows * g.columns, [&](int i) {
    const int row = i / g.columns, column = i % g.columns;
    const PanelCell& contents = layout.rows[static_cast<std::size_t>(row)].cells[static_cast<std::size_t>(column)];
    const Image picture = cell_picture(contents, cell, g.font, results);
    paste(sheet, picture, g.left(column) + (cell - picture.width()) / 2, g.top(row) + (cell - picture.height()) / 2);
    if (!contents.note.empty()) paste(sheet, caption(contents.note, g.font, strip), g.left(column), g.top(row) + cell);
  });
  return sheet;
}

}  // namespace textonbench
