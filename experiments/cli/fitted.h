// METHOD EXEMPLAR of the command line as a model.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/cli/command.h"
#include "methods/base/image_maps.h"
#include "methods/method.h"

namespace textonbench::cli {

struct Fitted {
  std::unique_ptr<Model> model;
  std::vector<ImageMap> maps;  ///< of a stack
  Domain domain;
  double seconds = 0;                             ///< of the analysis
  std::map<std::string, ParamValue> params = {};  ///< of a method, with its defaults
};

/// Throws std::invalid_argument with the reason for what the method refuses.
Fitted fit_to_exemplar(const ModelOptions& asked, bool quiet);

}  // namespace textonbench::cli
