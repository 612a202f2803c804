// Method "filtered_noise": texton noise on the ground under a camera, filtered pixel by pixel (CGF 2017, Section 5 and
// Figure 3), or on the plane minified by the step of the domain.
//
// Its field is that of texton_noise of the same options and seed. Every pixel is evaluated by itself, as a shader does
// it: `supersampled` is the mean of 20 x 20 evaluations of `none` a pixel, and what the filters are held against.
#pragma once

#include "methods/method.h"

namespace textonbench {

MethodEntry filtered_noise_entry();

}  // namespace textonbench
