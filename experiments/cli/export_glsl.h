// `textonbench export glsl`
#pragma once

#include "experiments/cli/command.h"

namespace textonbench::cli {

Command export_glsl_command(CLI::App& parent, const GlobalOptions& globals);

}  // namespace textonbench::cli
