// The words of a table of frames, on a page and on a terminal.
#pragma once

#include <string>
#include <vector>

#include "paper_figures/frame_table.h"

namespace textonbench {

/// Titles of frame_cells. Frames a second that software drew are called so.
std::vector<std::string> frame_columns(const FrameTable& table);
/// Median and range in ms, frames a second, ns a pixel, fetches in 10⁹ a second and their part of the ceiling.
std::vector<std::string> frame_cells(const FrameRow& row);

/// Why no row at all has numbers, where the reason is one and the same; else empty.
std::string shared_obstacle(const FrameTable& table);

/// The paper's ms, frames a second and ns a pixel.
std::vector<std::string> paper_columns();
std::vector<std::string> paper_cells(const FrameRow& row);

}  // namespace textonbench
