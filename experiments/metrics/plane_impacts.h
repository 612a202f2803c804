// Statements on the impacts of texton noise and their cells (Galerne, Leclaire, Moisan, CGF 2017, Sections 1 and 8),
// counted. Points and keys are drawn from the exemplar's name. Nothing for models that sum no splines.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Mean number, over 4096 random points x, of the cells of the model's own impacts that meet the reach of x: the points
/// whose kernels cover x, a rectangle of the support's size about x.
std::optional<double> cells_visited(const Model& model, const Target& target, const Domain& domain);

/// Mean number of the impacts that these cells hold, over MNI.
std::optional<double> impacts_drawn_ratio(const Model& model, const Target& target, const Domain& domain);

/// Mean number of those of them that lie in the reach of x: the values of the texton that a point asks for.
std::optional<double> fetches_per_pixel(const Model& model, const Target& target, const Domain& domain);

// Of the rounded Gaussian number that the paper takes for a Poisson number (methods/base/impact_grid.h), over 2^22
// draws of the mean m = 30 · 0.625² = 11.7 of a cell: mean over m and variance over m, negative numbers set to 0, and
// the part of them that is negative. Whatever the model.
std::optional<double> gaussian_count_mean(const Model& model, const Target& target, const Domain& domain);
std::optional<double> gaussian_count_variance(const Model& model, const Target& target, const Domain& domain);
std::optional<double> negative_count_part(const Model& model, const Target& target, const Domain& domain);

// Deviation (largest_deviation of replicates.h, of 256 blocks of 32 x 32 cells) from zero of the correlation between a
// cell and its neighbors at (1, 0), (0, 1), (1, 1) and (−1, 1), of the number of impacts and of the coordinates of the
// first two; 10.8 impacts a cell. Whatever the model.

/// Of the multiplicative congruential generator x ← 3039177861 x mod 2^32 of the published code of Gabor noise, started
/// at the number of the cell, 1024 cy + cx.
std::optional<double> congruential_cell_correlation(const Model& model, const Target& target, const Domain& domain);
/// Of the paper's generator: xorshift started at a hash of that number (ImpactProcess::paper).
std::optional<double> hashed_cell_correlation(const Model& model, const Target& target, const Domain& domain);
/// Of the generator of all other impacts here (ImpactProcess::poisson).
std::optional<double> counter_cell_correlation(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
