// The one interface of every texture model: analyze an exemplar, get a Model, synthesise from it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "methods/base/exemplar.h"
#include "methods/base/gaussian_model.h"
#include "methods/base/image.h"
#include "methods/base/mask.h"
#include "methods/base/params.h"
#include "methods/base/random.h"
#include "methods/base/shader_recipe.h"
#include "methods/base/texton.h"

namespace textonbench {

struct Point2 {
  double x = 0;
  double y = 0;
  friend bool operator==(const Point2&, const Point2&) = default;
};

/// Where a sample is wanted: `size` pixels whose centres are at origin + step * (i, j), in pixels of the exemplar.
/// A periodic domain is a torus of that size.
struct Domain {
  Extent size;
  Point2 origin{};
  double step = 1;
  bool periodic = false;
};

/// What a model is fitted to.
struct Problem {
  const Exemplar& exemplar;
  const Exemplar* second = nullptr;  ///< of a method with an option whose unit is "exemplar": what it names
  /// Of a method with an option whose unit is "mask": what is known of the exemplar.
  const Observation* observed = nullptr;
};

/// The model's own second-order law, in closed form.
class Gaussian {
 public:
  virtual ~Gaussian() = default;
  /// Mean of each channel.
  virtual std::vector<double> mean() const = 0;
  /// Cross-spectrum at the frequencies (kx / W, ky / H) of a grid, scaled as in gaussian_model.h. On a periodic domain
  /// the grid is the domain's size; otherwise it is any grid, and the covariance on Z² is recovered exactly once
  /// the grid is at least twice the support of the covariance.
  virtual CrossSpectrum spectrum(Extent grid) const = 0;
};

/// Evaluation of a sample at any point of the plane.
class Procedural {
 public:
  virtual ~Procedural() = default;
  /// out[c * points.size() + i] = channel c of the sample `seed` at points[i], in pixels of the exemplar: the field
  /// whose rasters synthesize() draws, to 1e-5 of its standard deviation. The same point gives the same bits in any
  /// call. Throws std::invalid_argument for a point that is not finite or beyond 2^40 pixels from the origin.
  virtual void evaluate(std::span<const Point2> points, Seed seed, std::span<float> out) const = 0;
  /// How often the field can be differentiated; gradients exist from 1 on (almost everywhere at 1).
  virtual int smoothness() const = 0;
  /// ∂/∂x of all channels, then ∂/∂y of all channels, a pixel; as evaluate(). Throws std::invalid_argument at
  /// smoothness 0.
  virtual void gradient(std::span<const Point2> points, Seed seed, std::span<float> out) const = 0;
};

/// A law given what is known of one picture: samples are the picture wherever it is known.
class Conditional {
 public:
  virtual ~Conditional() = default;
  /// The pixels that are drawn.
  virtual const Mask& missing() const = 0;
  /// The known pixels that they are drawn given.
  virtual const Mask& conditioning() const = 0;
  /// The conditional mean at the missing pixels, the picture elsewhere.
  virtual Image kriging() const = 0;
  /// What the sample of that seed adds to it, zero where the picture is known: mean zero.
  virtual Image innovation(Seed seed) const = 0;
  /// A sample of the law given nothing at the missing pixels, the picture elsewhere.
  virtual Image unconditional(Seed seed) const = 0;
};

/// Cost of a model: bytes that must be kept to synthesise, and arithmetic operations (a complex multiplication counts
/// 6, an FFT 2.5 n log2 n a real plane) for each output pixel on `domain`.
struct Footprint {
  std::size_t model_bytes = 0;
  double operations_per_pixel = 0;
};

/// How an iterative analysis came to its result.
struct Convergence {
  std::string_view step;    ///< what is counted: "iteration" or "evaluation"
  std::vector<double> rme;  ///< relative model error after each step, before any correction of colors
  std::string_view reason;  ///< why it stopped: "iterations", "evaluations", "tolerance" or "no descent"
};

/// What analysis returns: immutable, safe to share between threads. A capability that a model lacks is a null pointer.
class Model {
 public:
  virtual ~Model() = default;
  /// One sample. Same seed, same bits, whatever the number of threads. Throws std::invalid_argument with a reason for a
  /// domain that MethodEntry::refuses would refuse.
  virtual Image synthesize(const Domain& domain, Seed seed) const = 0;
  virtual const Gaussian* gaussian() const { return nullptr; }
  virtual const Procedural* procedural() const { return nullptr; }
  /// The kernels that the model sums, when it is a spot noise on Z².
  virtual const Texton* texton() const { return nullptr; }
  /// The coefficients that the model sums as B-splines, when it is a noise of the plane.
  virtual const SplineTexton* spline_texton() const { return nullptr; }
  /// A slow model whose sample of a seed this one's sample of that seed approximates.
  virtual std::unique_ptr<Model> reference() const { return nullptr; }
  /// How a graphics processor evaluates the model, when it can. Throws std::invalid_argument with a reason for a
  /// request that it cannot serve.
  virtual std::optional<ShaderRecipe> shader(const ShaderRequest& /*request*/) const { return std::nullopt; }
  /// Of a law that is conditional on a picture.
  virtual const Conditional* conditional() const { return nullptr; }
  /// Of a model that an iteration fitted.
  virtual const Convergence* convergence() const { return nullptr; }
  virtual Footprint footprint(const Domain& domain) const = 0;
  /// What a user should know of its samples on a domain, in words: that they are aliased, or the fit did not converge.
  virtual std::optional<std::string> warning(const Domain& /*domain*/) const { return std::nullopt; }
};

/// One row of the catalogue.
struct MethodEntry {
  std::string_view name;       ///< as on the command line: "adsn"
  std::string_view title;      ///< "Asymptotic discrete spot noise"
  std::string_view reference;  ///< paper, section or equation
  std::span<const ParamSpec> params;
  /// A reason, in words for a user, why this method cannot serve the problem on this domain; nothing when it can.
  std::optional<std::string> (*refuses)(const Problem&, const Params&, const Domain&);
  std::unique_ptr<Model> (*analyze)(const Problem&, const Params&, Seed);
};

/// All methods, in the order they are listed. See catalog.cpp.
std::span<const MethodEntry> method_catalog();

/// Entry of that name. Throws std::invalid_argument naming the nearest known name.
const MethodEntry& find_method(std::string_view name);

}  // namespace textonbench
