// A picture panel as one image, for papers.
#pragma once

#include "methods/base/image.h"
#include "paper_figures/panel.h"

namespace textonbench {

/// Where the cells of a panel lie in its image.
struct PanelGeometry {
  int cell, gap, margin, font, header, footer, rows, columns;

  int left(int column) const { return margin + header + column * (cell + gap); }
  int top(int row) const { return margin + header + row * (cell + footer + gap); }
  Extent extent() const { return {left(columns) - gap + margin, top(rows) - gap + margin}; }
};
PanelGeometry panel_geometry(const PanelLayout& layout, int cell);

/// SHA-256 of everything that draw_panel depends on: captions, reasons, picture files (named by their content) and the
/// program itself.
std::string panel_digest(const PanelLayout& layout, int cell, const ResultsFolder& results);

/// White sheet with column captions above and row captions, turned, at the left. A cell without a picture says why.
Image draw_panel(const PanelLayout& layout, int cell, const ResultsFolder& results);

}  // namespace textonbench
