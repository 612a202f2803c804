// Models on a graphics processor.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "methods/method.h"

namespace textonbench {

/// How a graphics processor draws the sample `request.seed` of a model that `method` made. Throws
/// std::invalid_argument with the methods that it can draw when this one is none of them, or these options of it are
/// not.
ShaderRecipe shader_of(const Model& model, std::string_view method, const ShaderRequest& request);

/// Names of the methods whose models, with the usual options, a graphics processor draws. They are fitted to an
/// small exemplar to know.
std::vector<std::string> methods_with_shader();

}  // namespace textonbench
