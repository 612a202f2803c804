// Student's t distribution.
#pragma once

namespace textonbench {

/// P(T <= t) for a whole number of degrees of freedom, by the finite series of Abramowitz and Stegun 26.7.3–4. Relative
/// error below 1e-12 in the body; tails below 1e-15 are lost to cancellation. Throws std::invalid_argument for degrees
/// below 1.
double student_cdf(double t, int degrees);

/// Its inverse for p in (0, 1), otherwise std::invalid_argument.
double student_quantile(double p, int degrees);

}  // namespace textonbench
