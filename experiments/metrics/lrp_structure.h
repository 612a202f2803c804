// The structure of local random-phase noise held against what its paper says: all null for a model of another kind or
// without a structure.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Root-mean-square difference of a sample of the block's size from the block of the exemplar, over the standard
/// deviation of the block.
std::optional<double> lrp_copy_error(const Model& model, const Target& target, const Domain& domain);
/// The same of what equation 4 prints, which does not divide by the windows' sum: Δ as wide as the block.
std::optional<double> lrp_printed_copy_error(const Model& model, const Target& target, const Domain& domain);
/// Mean |difference| from the structure image, and the side of the blocks that it took.
std::optional<double> lrp_structure_deviation(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_block_side(const Model& model, const Target& target, const Domain& domain);
/// Frequencies that are kept: those that windows draw from, and those of all blocks of the structure.
std::optional<double> lrp_table_entries(const Model& model, const Target& target, const Domain& domain);
/// Root-mean-square change over 2^−10 pixel of where the structure is looked up, σ, across borders of blocks of random
/// placement: with placement inside of turbulence, and the other way round. Null without turbulence.
std::optional<double> lrp_distortion_jump(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_swapped_distortion_jump(const Model& model, const Target& target, const Domain& domain);
/// Largest change over 2^−12 pixel, in standard deviations of the exemplar, across borders of windows, of cells and of
/// blocks. Not null without a structure.
std::optional<double> lrp_jump(const Model& model, const Target& target, const Domain& domain);
/// Processor time a point over that of noise alone, of as many cosines; the same with random placement over without it.
std::optional<double> lrp_fixed_time_ratio(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_placement_time_ratio(const Model& model, const Target& target, const Domain& domain);
/// Mean |difference| in dB of the power of the structure in octaves of the radial frequency, those with 1 % of it and
/// more, from that of the structure without turbulence and placement.
std::optional<double> lrp_radial_change(const Model& model, const Target& target, const Domain& domain);
}  // namespace textonbench
