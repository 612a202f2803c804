// [--scene …] and what belongs to it, of fps and synth.
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "experiments/scene.h"

namespace textonbench::cli {

class FrameOptions {
 public:
  void add_to(CLI::App& app);
  /// Whether one of them stands on the command line.
  bool any_given() const;
  /// Throws std::invalid_argument for an option of another scene than the one that is asked for.
  SceneOptions read(const ShaderRecipe& recipe) const;

 private:
  SceneOptions options_;
  double tilt_ = 0;
  std::vector<const CLI::Option*> given_, of_ground_, of_surface_;
  const CLI::Option* tilt_option_ = nullptr;
};

}  // namespace textonbench::cli
