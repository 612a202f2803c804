// The gnuplot script of a chart.
#pragma once

#include <string>

#include "paper_figures/chart.h"

namespace textonbench {

/// Script that writes <name>.svg and <name>.pdf into the folder where it is run. Point k of `chart.points` carries the
/// hypertext "#k".
std::string chart_script(const ChartContents& chart, const std::string& name);

}  // namespace textonbench
