// Gaussian inpainting: conditional simulation of a texture given what is known of it (Lectures 2022, "Inpainting of a
// Gaussian texture"; Galerne and Leclaire, SIAM J. Imaging Sciences 2017).
//
//   v = m + (u − m)* + (F − F*)   at the missing pixels, v = u elsewhere,
//
// F an unconditional sample of the model minus its mean, and * the kriging estimate from the conditioning pixels C, the
// known pixels within `border` of the missing ones. By linearity one system is solved a sample, Γ_CC k = (u − m − F)_C.
#pragma once

#include <memory>
#include <optional>

#include "methods/conditional/solver.h"
#include "methods/method.h"

namespace textonbench {

struct InpaintingOptions {
  int border = 3;
  bool periodic = false;  ///< covariance of the torus of the picture's size instead of that of the plane
  double nugget = 0;      ///< variance of the white noise, relative to the mean variance of the channels
  SolveOptions solve = {};
  /// The model is estimated in this part of the picture instead of from all known pixels.
  std::optional<Rectangle> clean = {};
};

/// The model of the picture `u`, whose missing pixels are never read. `other`, when given, is the exemplar that the
/// model is estimated from. Throws std::invalid_argument for bad input, with what was expected: nothing or everything
/// missing, sizes or numbers of channels that differ, sizes of `clean`, what estimate_field refuses, a picture whose
/// missing pixels leave no conditioning pixel, a singular system.
class Inpainting final : public Model, public Conditional {
 public:
  Inpainting(const Exemplar& u, const Observation& observed, const Exemplar* other, const InpaintingOptions& options);
  ~Inpainting() override;

  /// On the picture's own raster only.
  Image synthesize(const Domain& domain, Seed seed) const override;
  Footprint footprint(const Domain& domain) const override;
  const Conditional* conditional() const override { return this; }

  const Mask& missing() const override;
  const Mask& conditioning() const override;
  Image kriging() const override;
  Image innovation(Seed seed) const override;
  Image unconditional(Seed seed) const override;

  /// A sample and how its system was solved.
  struct Sample {
    Image image;
    SolveSummary summary;
  };
  Sample sample(Seed seed, const SolveObserver& observer = {}) const;
  /// Kriging component (m + (u − m)*) alone, and its solution: coefficients k and summary.
  struct Kriging {
    Image image;
    KrigingSystem::Solution solution;
  };
  Kriging solve_kriging(const SolveObserver& observer = {}) const;

  const KrigingOperator& kriging_operator() const;
  const KrigingSystem& system() const;
  /// (u − m)_C, as unknowns.
  std::vector<double> right_side() const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

MethodEntry inpainting_entry();

}  // namespace textonbench
