// Nonparametric tests and their correction for being many.
#pragma once

#include <span>
#include <vector>

namespace textonbench {

/// Two-sided p-value of Wilcoxon's signed-rank test of "differences are symmetric about zero". Zeros are left out;
/// ties share their mean rank. Exact (also with ties) for up to 25 differences that are not zero, beyond that by the
/// normal approximation with tie and continuity correction. 1 when every difference is zero or there is none. Throws
/// std::invalid_argument for a difference that is not finite.
double wilcoxon_signed_rank(std::span<const double> differences);

/// Holm's step-down correction: adjusted p-values in the order given. Rejecting those of at most α wrongly rejects
/// anything with probability at most α, whatever their dependence.
std::vector<double> holm(std::span<const double> p_values);

}  // namespace textonbench
