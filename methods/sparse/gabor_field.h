// Sparse convolution of Gabor kernels (Lagae, Lefebvre, Drettakis, Dutré, SIGGRAPH 2009):
//
//   n(x) = Σ_i w_i Re( c_i exp(2πi (f_i · (x − x_i) + u_i)) ) g(|x − x_i|),   g(r) = exp(−π a² r²) for r < R, else 0,
//
// x_i random impacts of the plane (impact_grid.h), w_i random weights, f_i frequencies and c_i complex colors drawn
// from a table, and u_i phases in turns. A field is a sum of bands, one for each bandwidth a.
//
// Positions are integers in 2^−22 pixel and phases integers in 2^−32 turn, as in wave_field.h.
//
// Random numbers. Band b of a seed has the stream Stream(seed).child("gabor").child(b), of key K; its impacts are those
// of ImpactGrid with that key. An impact at (x, y) takes the words of the Philox block with the key of child("kernel")
// and the counter (x, y): word 0 draws the table's entry, 1 the phase, 2 a uniform weight.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/base/impact_grid.h"
#include "methods/base/random.h"

namespace textonbench {

/// random: uniform. cosine: 0, sine: −1/4 turn for every impact.
enum class GaborPhase { random, cosine, sine };

/// impacts: those of the impacts, ±1 or 1. uniform: times a uniform number in (−1, 1), as in the paper.
enum class GaborWeight { impacts, uniform };

struct GaborFrequency {
  double x = 0;  ///< cycles a pixel, in [−1, 1]
  double y = 0;
};

struct GaborBand {
  double bandwidth = 0;  ///< a, 1 / pixel
  double radius = 0;     ///< R, pixels, at most 512
  double intensity = 0;  ///< impacts a pixel
  std::vector<GaborFrequency> frequency;
  /// chance[e] = 2^32 times the probability of the entries up to e, cut to 32 bits.
  std::vector<std::uint32_t> chance;
  std::vector<std::complex<float>> color;  ///< [e * channels + c], amplitude included

  std::size_t bytes() const;
};

struct GaborField {
  int channels = 1;
  ImpactProcess process = ImpactProcess::stratified;
  GaborPhase phase = GaborPhase::random;
  GaborWeight weight = GaborWeight::impacts;
  std::vector<GaborBand> bands;

  /// E w².
  double weight_power() const { return weight == GaborWeight::uniform ? 1.0 / 3 : 1; }
};

/// R with g(R) = `cut`: sqrt(−ln cut / π) / a.
double gabor_radius(double bandwidth, double cut);

/// 2π ∫ r g² dr, of the truncated kernel; and of its cosine squared minus its sine squared, 2π ∫ r g² J_0(4π |f| r) dr.
double gabor_energy(const GaborBand& band);
double gabor_imbalance(const GaborBand& band, const GaborFrequency& frequency);

/// A kernel that was drawn.
struct GaborImpact {
  std::int64_t x = 0;  ///< 2^−22 pixel
  std::int64_t y = 0;
  float weight = 1;
  std::uint32_t phase = 0;
  std::uint32_t entry = 0;
};

/// A band's impacts for one seed.
class GaborImpacts {
 public:
  GaborImpacts(const GaborField& field, std::size_t band, Seed seed);
  /// Appends the impacts in a rectangle, in the order of ImpactGrid::draw().
  void draw(const PlaneRectangle& rectangle, std::vector<GaborImpact>& impacts);

 private:
  const GaborField* field_;
  const GaborBand* band_;
  ImpactGrid grid_;
  std::uint64_t key_, kernel_key_;
  std::vector<PlaneImpact> drawn_;
};

}  // namespace textonbench
