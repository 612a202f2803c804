// Noise that sums a texton at random points of Z² or of a torus: the model behind every method of this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "methods/base/texton.h"
#include "methods/method.h"
#include "methods/spot/impacts.h"

namespace textonbench {

/// Where the impacts fall. `gaussian` is the limit of infinitely many (ADSN of the texton).
enum class Impacts { gaussian, poisson, stratified };

/// How the sum is computed: kernel rows added impact by impact, counts convolved by FFT, or whichever costs less.
enum class SpotRoute { automatic, direct, spectral };

struct SpotNoiseOptions {
  Impacts impacts = Impacts::poisson;
  double mni = 30;  ///< mean number of impacts that cover a pixel, intensity * |S|; above 0
  SpotRoute route = SpotRoute::automatic;
};

/// The options "impacts" (gaussian|poisson|stratified), "mni", "intensity" and "route" (auto|direct|spectral) with the
/// given default of the first, and their values. "intensity", impacts a pixel, takes the place of "mni" when it is not
/// zero.
std::vector<ParamSpec> spot_noise_params(std::string_view default_impacts);
SpotNoiseOptions spot_noise_options(const Params& params, std::int64_t support_pixels);

/// Throws std::invalid_argument for kernels of different sizes, no support, non-finite values or an MNI that is not
/// positive and finite. `convergence` is what the model tells of the fit of its texton.
std::unique_ptr<Model> make_spot_noise(Texton texton, const SpotNoiseOptions& options,
                                       std::optional<Convergence> convergence = std::nullopt);

/// How a model sums its texton, as make_spot_noise was told; null for a model that it did not make.
const SpotNoiseOptions* spot_noise_of(const Model& model);

/// Cells of stratified impacts on a domain, `intensity` impacts a pixel or nearly so.
CellLattice impact_lattice(double intensity, const Domain& domain);

/// A reason why no spot noise serves that domain.
std::optional<std::string> refuse_spot_noise(Extent texton, const Domain& domain);

}  // namespace textonbench
