// What local random-phase noise is made of, held against what its paper says: all null for a model of another kind.
#pragma once

#include <optional>

#include "experiments/metrics/metric.h"

namespace textonbench {

/// Least and greatest number of windows that are not zero at a point.
std::optional<double> lrp_least_windows(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_most_windows(const Model& model, const Target& target, const Domain& domain);
/// (max − min) / mean over a cell of Σ w, w the model's window.
std::optional<double> lrp_envelope_ripple(const Model& model, const Target& target, const Domain& domain);
/// The same of Σ v², v being the windows as the model scales them: the local variance of a layer.
std::optional<double> lrp_variance_ripple(const Model& model, const Target& target, const Domain& domain);
/// log2 of the ratio of the radii that hold 75 % of the energy around a frequency, with windows of twice the width over
/// those of one.
std::optional<double> lrp_leakage_exponent(const Model& model, const Target& target, const Domain& domain);
/// Largest |w − converged Bessel window|: of the model's window, and of five terms of the series of I_3.
std::optional<double> lrp_window_error(const Model& model, const Target& target, const Domain& domain);
std::optional<double> lrp_five_terms_error(const Model& model, const Target& target, const Domain& domain);
/// Energy of the window's spectrum outside of its main lobe, over that of the Gaussian cut off at ±1.5 whose spectrum
/// holds 75 % of its energy within the same radius.
std::optional<double> lrp_concentration_ratio(const Model& model, const Target& target, const Domain& domain);
/// ∫ r w² dr.
std::optional<double> lrp_radial_energy(const Model& model, const Target& target, const Domain& domain);
/// Largest relative difference between the variance of a layer, in closed form, and that of its stratum.
std::optional<double> lrp_stratum_variance_error(const Model& model, const Target& target, const Domain& domain);
/// Largest difference between the energy of a stratum and an equal share, over that of the largest bin.
std::optional<double> lrp_strata_imbalance(const Model& model, const Target& target, const Domain& domain);
/// Part of the energy of a layer's window within the distance that its stratum was eroded by.
std::optional<double> lrp_erosion_energy(const Model& model, const Target& target, const Domain& domain);
/// Noise-equivalent area of a stratum's windows in the half plane, over that of its bins there; mean over strata.
std::optional<double> lrp_coverage(const Model& model, const Target& target, const Domain& domain);
/// Windows and cosines that were evaluated for a point.
std::optional<double> lrp_calls(const Model& model, const Target& target, const Domain& domain);
/// The same over 9 (J + s), J cosines in s layers.
std::optional<double> lrp_calls_ratio(const Model& model, const Target& target, const Domain& domain);

}  // namespace textonbench
