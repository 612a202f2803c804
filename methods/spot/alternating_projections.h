// Synthesis-oriented texton by alternating projections (Galerne, Leclaire, Moisan, EUSIPCO 2014, Algorithm 2): an
// approximate square root, of prescribed support S, of the covariance of an exemplar.
//
// One iteration replaces the texton t by
//
//   t ← 1_S · IDFT(T s),   s(ξ) = (T* t̂)(ξ) / |(T* t̂)(ξ)|   (1 where T* t̂ is zero),
//
// with T the spectrum of the exemplar's normalised spot, T(0) = 0, and T* t̂ = Σ_c conj(T_c) t̂_c: one phase a
// frequency for all channels, so that the exemplar's phases between channels are kept.
//
// For the coefficients of a B-spline texton (CGF 2017, section 4.1) T is T_u / b̂^{1/2}, T_u being the exemplar's: then
// |α̂|² b̂ is |T_u|² where α̂ = T s (spline_spectrum.h). At order 0 b̂ = 1 and the two are one algorithm.
#pragma once

#include <vector>

#include "methods/base/gaussian_model.h"
#include "methods/base/random.h"
#include "methods/base/texton.h"
#include "methods/spot/support.h"

namespace textonbench {

struct ProjectionOptions {
  int iterations = 50;   ///< at most so many, at least 1
  double tolerance = 0;  ///< stop once an iteration lowers the RME by no more than this part of it; 0: never
  int order = 0;         ///< of the B-spline that the coefficients belong to, 0 to max_bspline_order
};

struct ProjectionSummary {
  enum class Stop { iterations, tolerance };
  int iterations = 0;  ///< iterations made
  /// Relative model error of the noise, ‖|α̂| b̂^{1/2} − |T_u|‖ / ‖T_u‖, after each of them. At order 0 it never rises
  /// but by rounding (1e-6); above, what never rises is the distance of |α̂| to |T_u| / b̂^{1/2}.
  std::vector<double> rme;
  Stop stop = Stop::iterations;
};

struct ProjectedTexton {
  Texton texton;  ///< one kernel, or its coefficients, of the size of S' box
  ProjectionSummary summary;
};

/// Runs the algorithm from `start`, the spectrum of any image of the exemplar's size, of which the first iteration
/// keeps the phases of T* start. S lies at the corner (0, 0) of the torus. The spectrum that an iteration computes
/// gives the RME of the iteration before; only the last one costs a transform of its own. The same start gives the same
/// bits, whatever the number of threads; rounding errors grow to 2e-4 of the largest coefficient in 50 iterations.
/// Throws std::invalid_argument unless the model has one factor, the start has its size, S fits into
/// it, iterations >= 1, 0 <= tolerance < 1 and the order exists.
ProjectedTexton alternate_projections(const GaussianModel& model, const Support& support, const Spectrum& start,
                                      const ProjectionOptions& options);

/// T with a phase added that is random, independent between frequencies and common to the channels.
Spectrum random_phase_start(const Spectrum& spot, Seed seed);

/// Spectrum of white Gaussian noise, independent between channels.
Spectrum white_start(const Spectrum& spot, Seed seed);

}  // namespace textonbench
