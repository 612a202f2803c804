// The Gaussian texture that a spot noise tends to.
#pragma once

#include <memory>

#include "methods/method.h"

namespace textonbench {

/// The model with infinitely many impacts of its texton; null when it has none, or one of B-splines.
std::unique_ptr<Model> gaussian_limit(const Model& model);

}  // namespace textonbench
