// Sparse convolution of Gabor kernels (Lagae, Lefebvre, Drettakis, Dutré, SIGGRAPH 2009):
//
//   n(x) = Σ_i w_i Re( c_i exp(2πi (f_i · (x − x_i) + u_i)) ) g(x − x_i),   g(y) = exp(−π y^T A y), 0 below a cut,
//
// x_i random impacts of the plane (impact_grid.h), w_i random weights, f_i frequencies and c_i complex colors drawn
// from a table, and u_i phases in turns. A field is a sum of bands, one for each window g; the paper's are round, A =
// a² times the identity with the bandwidth a.
//
// Positions are integers in 2^−22 pixel and phases integers in 2^−32 turn, as in wave_field.h.
//
// Random numbers. Band b of a seed has the stream Stream(seed).child("gabor").child(b), of key K; its impacts are those
// of ImpactGrid with that key. An impact at (x, y) takes the words of the Philox block with the key of child("kernel")
// and the counter (x, y): word 0 draws the table's entry, 1 the phase, 2 a uniform weight. Entry: of n w_0 = h 2^32 +
// l, n the number of entries, h if l < threshold[h], else alias[h] (Walker's alias method).
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/impact_grid.h"
#include "methods/base/random.h"

namespace textonbench {

/// random: uniform. cosine: 0, sine: −1/4 turn for every impact.
enum class GaborPhase { random, cosine, sine };

/// impacts: those of the impacts, ±1 or 1. uniform: times a uniform number in (−1, 1), as in the paper.
enum class GaborWeight { impacts, uniform };

/// Place of a pair of channels d <= c among all pairs.
inline std::size_t color_pair_of(int c, int d) {
  const auto one = static_cast<std::size_t>(c), other = static_cast<std::size_t>(d);
  return one * (one + 1) / 2 + other;
}

struct GaborFrequency {
  double x = 0;  ///< cycles a pixel, in [−1, 1]
  double y = 0;
};

/// exp(−π (xx x² + 2 xy x y + yy y²)) where that is above `cut`, else 0. A positive definite form, 1 / pixel².
struct GaborWindow {
  double xx = 0;
  double xy = 0;
  double yy = 0;
  double cut = 0.01;

  static GaborWindow round(double bandwidth, double cut) {
    return {.xx = bandwidth * bandwidth, .xy = 0, .yy = bandwidth * bandwidth, .cut = cut};
  }
  double form(double x, double y) const { return xx * x * x + 2 * xy * x * y + yy * y * y; }
  double determinant() const { return xx * yy - xy * xy; }
  /// The form's value where the window is cut.
  double limit() const;
  /// Of the box around it, pixels; at most 512.
  double half_width() const;
  double half_height() const;
  /// Pixels where it is not zero.
  double area() const;
  /// ∫ g² and ∫ g⁴, cut.
  double energy() const { return (1 - cut * cut) / (2 * std::sqrt(determinant())); }
  double fourth_moment() const { return (1 - cut * cut * cut * cut) / (4 * std::sqrt(determinant())); }
};

struct GaborBand {
  GaborWindow window;
  double intensity = 0;  ///< impacts a pixel
  double cell = 0;       ///< side of the impacts' cells where their process leaves a choice, pixels
  /// Of which all frequencies are bins (kx / width, ky / height); empty where there is none.
  Extent raster{};
  std::vector<GaborFrequency> frequency;  ///< of each entry
  std::vector<std::uint32_t> threshold, alias;
  std::vector<std::complex<float>> color;  ///< [e * channels + c], amplitude included

  /// Makes thresholds and aliases for probabilities proportional to `weights`, one an entry, at least one above 0.
  void draw_by(std::span<const double> weights);
  /// The probability of each entry, as thresholds and aliases have it.
  std::vector<double> chances() const;
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

/// ∫ g² cos(4π f · x): of the kernel's cosine squared minus its sine squared.
double gabor_imbalance(const GaborWindow& window, const GaborFrequency& frequency);

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

  const ImpactGrid& grid() const { return grid_; }
  std::uint64_t key() const { return key_; }
  std::uint64_t kernel_key() const { return kernel_key_; }

 private:
  const GaborField* field_;
  const GaborBand* band_;
  ImpactGrid grid_;
  std::uint64_t key_, kernel_key_;
  std::vector<PlaneImpact> drawn_;
};

}  // namespace textonbench
