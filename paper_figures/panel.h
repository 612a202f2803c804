// Picture panel: one row an exemplar, one column a picture of a run.
//
// [[figures]] keys: `columns`, a list of tables with `run`, `picture` and `label`, and any of `seed`, `method`,
// `periodic`, `width`, `height` and the method's parameters to tell one run from the others; `cell`, the side of a cell
// in pixels (default 256). A picture larger than that is shown by its central part, or shrunk where the column says
// fit = "whole" (for spectra); a smaller one is enlarged by a whole factor. `note` of a column names a metric whose
// value stands below its pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "paper_figures/figure_kind.h"

namespace textonbench {

/// A picture of a run, or the reason why there is none.
struct PanelCell {
  const SelectedRun* run = nullptr;  ///< null when no run serves this exemplar in this column
  std::optional<Record> picture;     ///< {file, width, height}
  PictureFit fit = PictureFit::window;
  std::string absent;  ///< why there is no picture
  std::string note{};  ///< "RME 0.513"; empty without one
};

/// Why a cell is empty whose record names a picture file that is not there.
inline constexpr std::string_view lost_picture = "the picture file is gone; run again with --fresh";

struct PanelRow {
  std::string exemplar;
  std::vector<PanelCell> cells;
};

struct PanelLayout {
  std::vector<std::string> columns;  ///< their captions
  std::vector<PanelRow> rows;
  bool has_notes() const;
};

/// Throws ConfigError for a column that no run answers, or for which several runs answer on one exemplar.
PanelLayout lay_out_panel(const FigureInput& input);

void check_panel(const FigureInput& input);
/// <stem>.png, and beside it <stem>.inputs, a digest of what it was drawn from: decoding and compressing pictures takes
/// seconds, so a panel is drawn again only when that digest changes.
std::vector<std::filesystem::path> write_panel(const FigureInput& input, const ResultsFolder& results,
                                               const std::filesystem::path& stem);
std::string panel_html(const FigureInput& input, PictureStore& pictures, const std::filesystem::path& stem);

}  // namespace textonbench
