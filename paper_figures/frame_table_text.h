// The words of a table of frames, on a page and on a terminal.
#pragma once

#include <string>
#include <vector>

#include "paper_figures/frame_table.h"

namespace textonbench {

/// What drew the rows that have numbers, each once, sorted.
std::vector<std::string> renderers_of(const FrameTable& table);

/// Titles of frame_cells. Frames a second that software alone drew are called so.
std::vector<std::string> frame_columns(const FrameTable& table);
/// Median and range in ms, frames a second, ns a pixel, fetches in 10⁹ a second and their part of the ceiling. In a
/// table that software drew a part of, its frames a second are called so one by one.
std::vector<std::string> frame_cells(const FrameRow& row, const FrameTable& table);

/// Why no row at all has numbers, where the reason is one and the same; else empty.
std::string shared_obstacle(const FrameTable& table);

/// What drew the paper's frames, or "the paper" where the figure does not say.
std::string paper_machine(const FigureInput& input);
/// The paper's ms, frames a second and ns a pixel.
std::vector<std::string> paper_columns();
std::vector<std::string> paper_cells(const FrameRow& row);

}  // namespace textonbench
