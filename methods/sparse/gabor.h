// Gabor noise of given frequency, bandwidth and orientation (Lagae, Lefebvre, Drettakis, Dutré, SIGGRAPH 2009), with
// stratified impacts of random signs by default (Tavernier, Neyret, Vergne, Thollot, Eurographics 2019).
//
// It has the mean of its exemplar and the covariance of its colors; its spectrum is its own.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "methods/method.h"
#include "methods/sparse/gabor_field.h"

namespace textonbench {

struct GaborOptions {
  double frequency = 0.1;   ///< cycles a pixel
  double orientation = 0;   ///< degrees, of the first wave vector from the x axis towards the y axis
  int directions = 64;      ///< evenly spread over half a turn: 1 is anisotropic, many are isotropic
  double bandwidth = 0.05;  ///< a, 1 / pixel
  double cut = 0.01;        ///< g(R)
  double mni = 10;          ///< mean number of impacts that reach a point, λ π R²
  ImpactProcess process = ImpactProcess::stratified;
  GaborPhase phase = GaborPhase::random;
  GaborWeight weight = GaborWeight::impacts;
};

/// A reason why there is no such noise: impacts of weight 1 and of one phase, whose noise has a mean; kernels beyond
/// 512 pixels; a number out of range.
std::optional<std::string> refuse_gabor(const GaborOptions& options);

/// A reason why a domain cannot be served: a torus, a step that is not above 0, pixels beyond 2^40 from the origin.
std::optional<std::string> refuse_gabor_domain(const Domain& domain);

/// Of unit variance, gray. Throws std::invalid_argument where refuse_gabor() has a reason.
GaborField gabor_field(const GaborOptions& options);

/// A noise of bands, plus a mean: procedural, with a closed-form spectrum. `convergence` of what fitted it.
std::unique_ptr<Model> make_gabor(GaborField field, std::vector<double> mean,
                                  std::optional<Convergence> convergence = std::nullopt);

/// The field of such a model; null for another one.
const GaborField* gabor_field_of(const Model& model);

/// Entries of the catalogue.
MethodEntry gabor_entry();
MethodEntry gabor_by_example_entry();

}  // namespace textonbench
