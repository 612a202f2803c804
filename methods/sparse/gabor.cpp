#include "methods/sparse/gabor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "methods/base/convolution.h"
#include "methods/sparse/gabor_shader.h"
#include "methods/sparse/gabor_spectrum.h"
#include "methods/sparse/gabor_sum.h"

namespace textonbench {
namespace {

constexpr double furthest_impact_place = 0x1p40;
constexpr double widest_kernel = 512;

bool is_in_reach(const Point2& p) {
  return std::abs(p.x) <= furthest_impact_place && std::abs(p.y) <= furthest_impact_place;
}

/// Operations of a kernel on a raster of whole pixels, as add_gabor makes them: two fused multiply-adds, of two
/// operations each, a channel and pixel; 55 for the distance, turns, cosine, sine and window of each column and row;
/// six for each row and channel that is multiplied by its color; and 20 for the window of each pixel where it is
/// skewed. Comparisons with the cut, drawing and lanes that lie outside are not counted.
double kernel_operations(const GaborWindow& window, int channels) {
  const double columns = 2 * window.half_width(), rows = 2 * window.half_height();
  const double of_pixel = 4 * channels + (window.xy == 0 ? 0 : 20);
  return of_pixel * window.area() + 55 * (columns + rows) + 6 * channels * rows;
}

/// Part of the power beyond half a cycle a step along an axis.
double aliased_power(const GaborField& field, double step) {
  double sum = 0, beyond = 0;
  for (const GaborBand& band : field.bands) {
    const std::vector<double> chance = band.chances();
    const auto channels = static_cast<std::size_t>(field.channels);
    for (std::size_t e = 0; e < chance.size(); ++e) {
      double power = 0;
      for (std::size_t c = 0; c < channels; ++c) power += double{std::norm(band.color[e * channels + c])};
      power *= chance[e] * band.intensity * band.window.energy();
      sum += power;
      const GaborFrequency& f = band.frequency[e];
      if (std::max(std::abs(f.x), std::abs(f.y)) * step > 0.5 + 1e-9) beyond += power;
    }
  }
  return beyond / sum;
}

class GaborNoise final : public Model, public Gaussian, public Procedural {
 public:
  GaborNoise(GaborField field, std::vector<double> mean, std::optional<Convergence> convergence)
      : field_(std::move(field)), mean_(std::move(mean)), convergence_(std::move(convergence)) {}

  const GaborField& field() const { return field_; }

  Image synthesize(const Domain& domain, Seed seed) const override {
    if (const auto reason = refuse_gabor_domain(domain)) throw std::invalid_argument(*reason);
    Image out(domain.size, field_.channels);
    add_gabor(field_, seed, {domain.origin.x, domain.origin.y, domain.step}, out);
    add_constant(mean_, out);
    return out;
  }

  const Convergence* convergence() const override { return convergence_ ? &*convergence_ : nullptr; }
  const Gaussian* gaussian() const override { return this; }
  std::vector<double> mean() const override { return mean_; }
  CrossSpectrum spectrum(Extent grid) const override { return gabor_spectrum(field_, grid); }

  const Procedural* procedural() const override { return this; }
  void evaluate(std::span<const Point2> points, Seed seed, std::span<float> out) const override {
    if (out.size() != points.size() * mean_.size()) {
      throw std::invalid_argument(fmt::format("{} points of gabor into {} numbers: expected {} a point", points.size(),
                                              out.size(), mean_.size()));
    }
    std::vector<WavePoint> plane;
    plane.reserve(points.size());
    constexpr auto unit = static_cast<double>(std::int64_t{1} << plane_bits);
    for (const Point2& p : points) {
      if (!is_in_reach(p)) {
        throw std::invalid_argument(
            fmt::format("gabor at ({}, {}): expected a point within 2^40 pixels of the origin", p.x, p.y));
      }
      plane.push_back(
          {static_cast<std::int64_t>(std::floor(p.x * unit)), static_cast<std::int64_t>(std::floor(p.y * unit))});
    }
    sum_gabor(field_, seed, plane, out);
    for (std::size_t c = 0; c < mean_.size(); ++c) {
      for (float& v : out.subspan(c * points.size(), points.size())) v += static_cast<float>(mean_[c]);
    }
  }
  /// Kernels end where they are cut.
  int smoothness() const override { return 0; }
  void gradient(std::span<const Point2>, Seed, std::span<float>) const override {
    throw std::invalid_argument("gradients of gabor: its kernels are cut, and their sum jumps there");
  }

  std::optional<ShaderRecipe> shader(const ShaderRequest& request) const override {
    return gabor_recipe(field_, mean_, request);
  }

  std::optional<std::string> warning(const Domain& domain) const override {
    if (convergence_ && convergence_->reason == "iterations") {
      return fmt::format("its fit did not converge within {} iterations", convergence_->rme.size() - 1);
    }
    const double aliased = aliased_power(field_, domain.step);
    if (aliased < 1e-3) return std::nullopt;
    return fmt::format(
        "{:.1f} % of its power has more than half a cycle a pixel of the raster, and shows as lower frequencies; give "
        "a smaller --step, or footprint = {}",
        100 * aliased, domain.step);
  }

  Footprint footprint(const Domain&) const override {
    Footprint sum;
    for (const GaborBand& band : field_.bands) {
      sum.model_bytes += band.bytes();
      sum.operations_per_pixel += band.intensity * kernel_operations(band.window, field_.channels);
    }
    return sum;
  }

 private:
  GaborField field_;
  std::vector<double> mean_;
  std::optional<Convergence> convergence_;
};

}  // namespace

std::optional<std::string> refuse_gabor_domain(const Domain& domain) {
  if (domain.periodic) {
    return "gabor on a torus: its impacts are those of the plane; expected a domain that is not periodic";
  }
  if (!(std::isfinite(domain.step) && domain.step > 0)) {
    return fmt::format("gabor at a step of {} pixels: expected a finite number above 0", domain.step);
  }
  const Point2 last{domain.origin.x + domain.step * (domain.size.width - 1.0),
                    domain.origin.y + domain.step * (domain.size.height - 1.0)};
  for (const Point2& corner : {domain.origin, last}) {
    if (!is_in_reach(corner)) {
      return fmt::format("gabor at ({}, {}): expected pixels within 2^40 of the origin", corner.x, corner.y);
    }
  }
  return std::nullopt;
}

std::optional<std::string> refuse_gabor(const GaborOptions& options) {
  const auto in_range = [](double v, double low, double high) { return v >= low && v <= high; };
  if (!in_range(options.frequency, 0, 1)) {
    return fmt::format("gabor of {} cycles a pixel: expected a number from 0 to 1", options.frequency);
  }
  if (!(options.directions >= 1 && options.directions <= 4096)) {
    return fmt::format("gabor of {} directions: expected 1 to 4096", options.directions);
  }
  if (!std::isfinite(options.orientation)) {
    return fmt::format("gabor with an orientation of {} degrees: expected a finite number", options.orientation);
  }
  if (!(in_range(options.cut, 1e-6, 0.5) && options.bandwidth > 0 &&
        in_range(GaborWindow::round(options.bandwidth, options.cut).half_width(), 1, widest_kernel))) {
    return fmt::format(
        "gabor of bandwidth {} cut at {}: expected a cut in [1e-6, 0.5] and kernels of a radius of 1 to 512 pixels",
        options.bandwidth, options.cut);
  }
  if (!in_range(options.mni, 0.01, 1000)) {
    return fmt::format("gabor of {} impacts at a point: expected 0.01 to 1000", options.mni);
  }
  if (options.process == ImpactProcess::paper) return "gabor with the impacts of another paper's shader";
  if (options.process == ImpactProcess::poisson && options.phase != GaborPhase::random &&
      options.weight == GaborWeight::impacts) {
    return "gabor of poisson impacts, which have weight 1, of one phase: its mean is not zero; expected phase = "
           "random, "
           "impacts = signed_poisson or stratified, or weights = uniform";
  }
  return std::nullopt;
}

GaborField gabor_field(const GaborOptions& options) {
  if (const auto reason = refuse_gabor(options)) throw std::invalid_argument(*reason);
  GaborField field{
      .channels = 1, .process = options.process, .phase = options.phase, .weight = options.weight, .bands = {}};
  GaborBand& band = field.bands.emplace_back();
  band.window = GaborWindow::round(options.bandwidth, options.cut);
  band.cell = band.window.half_width();
  // Stratified cells are rounded to 1/1024 pixel.
  band.intensity = ImpactGrid(options.process, options.mni / band.window.area(), band.cell, 1).intensity();
  const int n = options.directions;
  for (int i = 0; i < n; ++i) {
    const double angle = std::numbers::pi * (options.orientation / 180 + static_cast<double>(i) / n);
    band.frequency.push_back({options.frequency * std::cos(angle), options.frequency * std::sin(angle)});
  }
  band.draw_by(std::vector<double>(band.frequency.size(), 1));
  band.color.assign(static_cast<std::size_t>(n), 1);
  const auto amplitude = static_cast<float>(1 / std::sqrt(gabor_covariance(field)(0, 0)));
  std::ranges::fill(band.color, std::complex<float>(amplitude));
  return field;
}

std::unique_ptr<Model> make_gabor(GaborField field, std::vector<double> mean, std::optional<Convergence> convergence) {
  return std::make_unique<GaborNoise>(std::move(field), std::move(mean), std::move(convergence));
}

const GaborField* gabor_field_of(const Model& model) {
  const auto* noise = dynamic_cast<const GaborNoise*>(&model);
  return noise == nullptr ? nullptr : &noise->field();
}

}  // namespace textonbench
