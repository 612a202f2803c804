// What independent replicates of a random vector say about the expectation that theory gives it.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace textonbench {

/// Replicate i of the vector, by [i][entry].
using Replicates = std::vector<std::vector<float>>;

/// draw(i) for i = 0 … count − 1, on all threads.
Replicates draw_replicates(int count, const std::function<std::vector<float>(int)>& draw);

/// max_j |m_j − expected_j| / (s_j / √n) over standard_error_limit of as many entries, m and s being mean and standard
/// deviation of the n replicates. Above 1 with probability 1 % at most when `expected` is the expectation, but for what
/// means of n replicates are not Gaussian; grows as √n otherwise. Infinite where replicates do not vary about another
/// number than the expected one. Throws std::invalid_argument for fewer than two replicates or another number of
/// entries.
double largest_deviation(const Replicates& replicates, std::span<const double> expected);

/// The number of standard errors that none of so many means exceeds but with probability 1 %: Bonferroni's correction,
/// and Student's t of `replicates` − 1 degrees of freedom by two terms of its Cornish–Fisher expansion (Abramowitz and
/// Stegun 26.7.5; within 1 % from 128 replicates and up to 10⁶ comparisons).
double standard_error_limit(std::size_t comparisons, int replicates);

}  // namespace textonbench
