// What RandomSequence::poisson() makes large Poisson numbers of: transformed rejection with squeeze, PTRS (Hörmann
// 1993). Apart, so that a shader draws the same numbers.
#pragma once

namespace textonbench {

/// Means from here on are drawn so; below, arrivals are counted.
constexpr double least_rejection_mean = 10;

struct PoissonRejection {
  double a = 0;
  double b = 0;
  double inverse_alpha = 0;
  double v_r = 0;  ///< candidates with v <= v_r and us >= 0.07 are taken at once
};

/// Of a mean of at least least_rejection_mean.
PoissonRejection poisson_rejection(double mean);

/// Logarithm of the Poisson probability of the whole number k >= 0.
double log_poisson(double k, double mean);

}  // namespace textonbench
