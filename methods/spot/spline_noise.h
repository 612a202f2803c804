// Texton noise (Galerne, Leclaire, Moisan, CGF 2017): a spline texton summed at random points of the plane.
//
//   f(y) = m + (1 / sqrt(λ)) Σ_i ε_i h_{k_i}(y − x_i) − …   (the mean of the sum taken off)
//
// with Poisson impacts (weights 1) or one signed impact a cell. Its covariance on any grid y + Z² is α * α~ * b.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "methods/base/impact_grid.h"
#include "methods/base/texton.h"
#include "methods/method.h"
#include "methods/spot/plane_share.h"

namespace textonbench {

/// How a raster is computed: point by point (any step), tiles summed impact by impact (step 1), by FFT convolution of
/// the splatted impacts (step 1), or whichever costs least by a measured model. All draw one field, to 1e-5 of its
/// standard deviation. Windows that overlap, their corners whole pixels apart, agree bit for bit by points and by
/// impacts, and so do the route points and evaluate(); by convolution, and where the automatic choice differs, they
/// agree to 1e-5.
enum class SplineRoute { automatic, points, impacts, convolution };

struct SplineNoiseOptions {
  ImpactProcess impacts = ImpactProcess::poisson;
  double mni = 30;  ///< mean number of impacts whose kernel covers a point; above 0, below 1 allowed
  double cell = 0;  ///< side of the Poisson process' cells in sides of the support; 0: the measured optimum (0.6 in the
                    ///< paper's process)
  SplineRoute route = SplineRoute::automatic;
  /// Where kernels are chosen by place: an impact takes the kernel of the share at its kernel's center (plane_share.h)
  /// in place of one by chance. Its impacts are signed, h_k is not scaled by sqrt(K), and the noise has no spectrum of
  /// its own.
  std::optional<PlaneShare> share = std::nullopt;
};

/// Throws std::invalid_argument for coefficients of different sizes or not finite, an order out of range, or options
/// out of range. The model is procedural, with a closed-form spectrum.
std::unique_ptr<Model> make_spline_noise(SplineTexton texton, const SplineNoiseOptions& options);

/// What such a noise was made with; null for another model.
const SplineNoiseOptions* spline_noise_of(const Model& model);

/// The impacts of that noise, drawn with the key that a seed gives. Throws as make_spline_noise does.
ImpactGrid spline_noise_impacts(const SplineTexton& texton, const SplineNoiseOptions& options);
std::uint64_t spline_noise_key(Seed seed);

/// A reason why texton noise cannot be drawn there (a torus, a step or corner that is not finite or out of range).
std::optional<std::string> refuse_spline_noise(const Domain& domain);

}  // namespace textonbench
