// Pictures of a law that is conditional on a picture.
#pragma once

#include <span>

#include "experiments/pictures.h"

namespace textonbench {

/// masked and conditioning (inpainting_pictures.h), kriging, innovation (of the first sample, plus the mean of the
/// known pixels), unconditional (a sample given nothing) and hole (a close-up of the first sample around the missing
/// pixels). Each throws std::invalid_argument for a model that is not conditional.
std::span<const PictureEntry> conditional_pictures();

}  // namespace textonbench
