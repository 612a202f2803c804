// Gaussian inpainting: conditional simulation of a texture given what is known of it (Lectures 2022, "Inpainting of a
// Gaussian texture"; Galerne and Leclaire, SIAM J. Imaging Sciences 10, 2017).
//
//   v = m + (u − m)* + (F − F*)   at the missing pixels, v = u elsewhere,
//
// F an unconditional sample of the model minus its mean, and * the kriging estimate from the conditioning pixels C, the
// known pixels within `border` of the missing ones. By linearity one system is solved a sample, Γ_CC k = (u − m − F)_C.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "methods/conditional/solver.h"
#include "methods/method.h"

namespace textonbench {

struct InpaintingOptions {
  int border = 3;         ///< pixels, at least 1
  bool periodic = false;  ///< covariance of the torus of the picture's size instead of that of the plane
  double nugget = 0;      ///< variance of white noise in the model, relative to the mean variance of the channels
  SolveOptions solve = {};
  std::optional<Rectangle> clean = {};  ///< the model is estimated in this part of the picture
};

/// The law of the missing pixels of a picture given the others. Missing pixels are never read.
class Inpainting final : public Model, public Conditional {
 public:
  /// The model is estimated from all known pixels, or from those of options.clean, or from the exemplar `other` (not
  /// null). Throws std::invalid_argument, with what was expected, for a mask of another size, nothing or everything
  /// missing, a border below 1, a part that is not in the picture, numbers of channels that differ, both a part and
  /// another exemplar, a negative nugget, what estimate_field() refuses, a known pixel that is not finite, and a
  /// singular system (solver.h).
  Inpainting(const Image& u, const Mask& missing, const Exemplar* other, const InpaintingOptions& options);

  Inpainting(const Inpainting&) = delete;
  Inpainting& operator=(const Inpainting&) = delete;

  /// On the picture's own raster only. The sample is drawn whether or not its system was solved to the tolerance:
  /// sample() tells.
  Image synthesize(const Domain& domain, Seed seed) const override;
  Footprint footprint(const Domain& domain) const override;
  const Conditional* conditional() const override { return this; }

  const Mask& missing() const override { return missing_; }
  const Mask& conditioning() const override { return conditioning_; }
  Image kriging() const override;
  Image innovation(Seed seed) const override;
  Image unconditional(Seed seed) const override;

  struct Sample {
    Image image;
    SolveSummary summary;
  };
  Sample sample(Seed seed, const SolveObserver& observer = {}) const;
  /// The kriging component: of (u − m)_C, the right side of its system.
  Sample kriging_sample(const SolveObserver& observer = {}) const;
  /// (u − m)_C, as unknowns.
  std::vector<double> right_side() const;
  /// The solution of that right side, found once.
  const KrigingSystem::Solution& kriging_solution() const;

  const KrigingOperator& kriging_operator() const { return operator_; }
  const KrigingSystem& system() const { return system_; }
  const InpaintingOptions& options() const { return options_; }

 private:
  /// The picture with m_c + values at the missing pixels.
  Image filled(std::span<const double> values) const;

  InpaintingOptions options_;
  Image picture_;  ///< zero where it is missing
  Mask missing_, conditioning_;
  KrigingOperator operator_;
  KrigingSystem system_;
  mutable std::once_flag solved_;
  mutable KrigingSystem::Solution solution_;
};

/// A reason when `domain` is not the raster of the picture.
std::optional<std::string> refuse_other_raster(Extent picture, const Domain& domain);

/// Of the entry's options, all but `mask`, `missing` and `model`.
InpaintingOptions inpainting_options(const Params& params);

MethodEntry inpainting_entry();

}  // namespace textonbench
