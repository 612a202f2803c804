// The [[figures]] tables of a config.
#pragma once

#include <string_view>
#include <vector>

#include "experiments/config.h"
#include "experiments/toml_reader.h"

namespace textonbench {

/// Reads one table. What its kind makes of the free-form keys is the kind's affair; but every run that it names, in
/// the list `runs` or by a key `run`, must be one of `labels`. Without the key `runs` it reads them all. Throws
/// ConfigError.
FigureTable read_figure_table(const TomlValue& value, const std::vector<std::string_view>& labels);

}  // namespace textonbench
