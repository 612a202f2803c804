// Table of the times of frames, beside those of a paper.
//
// [[figures]] keys: `rows`, a list of {run, label} with any of `paper_ms`, and the selectors of a panel's columns
// (seed, method, width, height and options, such as support or "gpu.path"): a row is the mean over its runs of their
// medians. They may differ in exemplar and seed only. `ratios`, a list of {label, of, over} with the labels of two rows
// and perhaps `paper`: the quotient of their times a pixel, none for frames of different renderers. `paper_machine`:
// what drew the paper's frames. Runs time frames (experiments/gpu_run.h); a row whose runs were refused says why.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "paper_figures/figure_kind.h"

namespace textonbench {

/// Means over runs of what a record's `timing` says.
struct FrameNumbers {
  double milliseconds = 0, p05 = 0, p95 = 0;
  double frames_per_second = 0;  ///< of milliseconds
  double ns_per_pixel = 0;
  double fetches_per_second = 0;
  double ceiling_fraction = 0;
};

struct FrameRow {
  std::string label;
  std::string renderer;  ///< "llvmpipe (LLVM 15.0.6, 256 bits) [software]"; of several, all of them
  bool software = false;
  std::size_t runs = 0;  ///< that the numbers are means of
  std::string record;    ///< id of the first of its runs; empty without one
  std::string obstacle;  ///< why there are no numbers
  std::optional<FrameNumbers> numbers;
  std::optional<double> paper_milliseconds, paper_ns_per_pixel;
};

struct FrameRatio {
  std::string label;
  std::optional<double> value, paper;
};

struct FrameTable {
  std::vector<FrameRow> rows;
  std::vector<FrameRatio> ratios;
};
FrameTable fill_frame_table(const FigureInput& input);

/// Besides what figure_kind.h says, throws ConfigError for two rows of one label, a row of unlike runs, a ratio of no
/// row, and a paper's number that is not above 0.
void check_frame_table(const FigureInput& input);
/// <stem>.csv (rows), <stem>_ratios.csv and <stem>.html.
std::vector<std::filesystem::path> write_frame_table(const FigureInput& input, const ResultsFolder& results,
                                                     const std::filesystem::path& stem);
std::string frame_table_html(const FigureInput& input, PictureStore& pictures, const std::filesystem::path& stem);

/// The tables for a terminal, with the figure's title.
std::string frame_table_text(const FigureInput& input);

}  // namespace textonbench
