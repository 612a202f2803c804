#include "methods/sparse/lrp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "methods/base/convolution.h"
#include "methods/sparse/wave_points.h"
#include "methods/sparse/wave_raster.h"
#include "methods/sparse/wave_shader.h"
#include "methods/sparse/wave_spectrum.h"

namespace textonbench {
namespace {

constexpr double furthest_coordinate = 0x1p40;

bool is_near(const Point2& p) { return std::abs(p.x) <= furthest_coordinate && std::abs(p.y) <= furthest_coordinate; }

std::optional<std::string> refuse_domain(const Domain& domain) {
  if (domain.periodic) {
    return "lrp on a torus: its windows are those of the plane; expected a domain that is not periodic";
  }
  if (!(std::isfinite(domain.step) && domain.step > 0)) {
    return fmt::format("lrp at a step of {} pixels: expected a finite number above 0", domain.step);
  }
  const Point2 last{domain.origin.x + domain.step * (domain.size.width - 1.0),
                    domain.origin.y + domain.step * (domain.size.height - 1.0)};
  for (const Point2& corner : {domain.origin, last}) {
    if (!is_near(corner)) {
      return fmt::format("lrp at ({}, {}): expected pixels within 2^40 of the origin", corner.x, corner.y);
    }
  }
  return std::nullopt;
}

class Lrp final : public Model, public Gaussian, public Procedural {
 public:
  explicit Lrp(LrpAnalysis analysis) : analysis_(std::move(analysis)) {}

  const LrpAnalysis& analysis() const { return analysis_; }

  Image synthesize(const Domain& domain, Seed seed) const override {
    if (const auto reason = refuse_domain(domain)) throw std::invalid_argument(*reason);
    Image out(domain.size, analysis_.field.channels);
    add_waves(analysis_.field, seed, {domain.origin.x, domain.origin.y, domain.step}, out);
    if (analysis_.fixed) add_structure(domain, seed, out);
    add_constant(mean(), out);
    return out;
  }

  /// A structure is the same in every sample: no Gaussian law.
  const Gaussian* gaussian() const override { return analysis_.fixed ? nullptr : this; }
  std::vector<double> mean() const override { return analysis_.spectrum.mean(); }
  CrossSpectrum spectrum(Extent grid) const override { return wave_spectrum(analysis_.field, grid); }

  const Procedural* procedural() const override { return this; }
  void evaluate(std::span<const Point2> points, Seed seed, std::span<float> out) const override {
    const auto channels = static_cast<std::size_t>(analysis_.field.channels);
    if (out.size() != points.size() * channels) throw std::invalid_argument(misfit(points.size(), out.size(), 1));
    const std::vector<WavePoint> plane = to_plane(points);
    sum_waves(analysis_.field, seed, plane, false, out);
    if (analysis_.fixed) analysis_.fixed->add(seed, plane, out);
    for (std::size_t c = 0; c < channels; ++c) {
      for (float& v : out.subspan(c * points.size(), points.size())) v += static_cast<float>(mean()[c]);
    }
  }
  int smoothness() const override { return analysis_.fixed ? 0 : 1; }
  void gradient(std::span<const Point2> points, Seed seed, std::span<float> out) const override {
    if (analysis_.fixed) throw std::invalid_argument("gradients of lrp with a structure: expected structure = 0");
    const std::size_t values = points.size() * static_cast<std::size_t>(analysis_.field.channels);
    if (out.size() != 2 * values) throw std::invalid_argument(misfit(points.size(), out.size(), 2));
    std::vector<float> all(3 * values);
    sum_waves(analysis_.field, seed, to_plane(points), true, all);
    std::copy(all.begin() + static_cast<std::ptrdiff_t>(values), all.end(), out.begin());
  }

  std::optional<ShaderRecipe> shader(const ShaderRequest& request) const override {
    const FixedPhases* fixed = analysis_.fixed ? &*analysis_.fixed : nullptr;
    return wave_recipe(analysis_.field, fixed, analysis_.spectrum.mean(), request);
  }

  Footprint footprint(const Domain&) const override {
    std::size_t bytes = 0;
    double operations = 0;
    for (const WaveLayer& layer : analysis_.field.layers) {
      bytes += layer.bytes();
      // Nine windows of a square root and a polynomial; of each wave two rows share two products.
      operations += 9 * (2 * lrp_window_terms + 6 + layer.waves() * 2 * analysis_.field.channels);
    }
    if (analysis_.fixed) {
      const FixedPhases& fixed = *analysis_.fixed;
      bytes += fixed.bytes();
      // A phase, its cosine and sine, and two multiplications and additions a channel; turbulence likewise.
      const double cosine = 24 + 4.0 * analysis_.field.channels;
      operations += fixed.structure.cosines_at_point() * cosine;
      for (const WaveField& field : fixed.turbulent) operations += 2 * 9 * 28.0 * field.layers.front().waves();
    }
    return {bytes, operations};
  }

 private:
  /// By points, some rows at a time.
  void add_structure(const Domain& domain, Seed seed, Image& out) const {
    constexpr int rows = 64;
    const auto channels = static_cast<std::size_t>(out.channels());
    std::vector<Point2> points;
    std::vector<float> values;
    for (int top = 0; top < out.height(); top += rows) {
      points.clear();
      for (int y = top; y < std::min(top + rows, out.height()); ++y) {
        for (int x = 0; x < out.width(); ++x) {
          points.push_back({domain.origin.x + domain.step * x, domain.origin.y + domain.step * y});
        }
      }
      values.assign(channels * points.size(), 0);
      analysis_.fixed->add(seed, to_plane(points), values);
      for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(out.width())) {
        const auto channel = static_cast<int>(i / points.size());
        const int y = top + static_cast<int>(i % points.size()) / out.width();
        for (int x = 0; x < out.width(); ++x) out.at(channel, x, y) += values[i + static_cast<std::size_t>(x)];
      }
    }
  }

  std::string misfit(std::size_t points, std::size_t numbers, int planes) const {
    return fmt::format("{} points of lrp into {} numbers: expected {} a point", points, numbers,
                       planes * analysis_.field.channels);
  }

  static std::vector<WavePoint> to_plane(std::span<const Point2> points) {
    std::vector<WavePoint> plane;
    plane.reserve(points.size());
    constexpr auto unit = static_cast<double>(std::int64_t{1} << plane_bits);
    for (const Point2& p : points) {
      if (!is_near(p)) {
        throw std::invalid_argument(
            fmt::format("lrp at ({}, {}): expected a point within 2^40 pixels of the origin", p.x, p.y));
      }
      plane.push_back(
          {static_cast<std::int64_t>(std::floor(p.x * unit)), static_cast<std::int64_t>(std::floor(p.y * unit))});
    }
    return plane;
  }

  LrpAnalysis analysis_;
};

}  // namespace

std::unique_ptr<Model> make_lrp(LrpAnalysis analysis) { return std::make_unique<Lrp>(std::move(analysis)); }

const LrpAnalysis* lrp_analysis_of(const Model& model) {
  const auto* noise = dynamic_cast<const Lrp*>(&model);
  return noise == nullptr ? nullptr : &noise->analysis();
}

namespace {

LrpOptions lrp_options(const Params& params) {
  LrpOptions options;
  options.welch.side = static_cast<int>(params.integer("block"));
  options.welch.overlap = params.number("overlap");
  options.welch.taper = params.text("taper") == "hann" ? Taper::hann : Taper::none;
  options.strata.strata = static_cast<int>(params.integer("strata"));
  options.strata.cosines = static_cast<int>(params.integer("cosines"));
  options.strata.spacing = params.number("spacing");
  options.strata.kept = params.number("kept");
  options.strata.window = params.text("window") == "bessel" ? LrpWindow::bessel : LrpWindow::printed;
  options.amplitude = params.text("amplitude") == "corrected" ? LrpAmplitude::corrected
                      : params.text("amplitude") == "printed" ? LrpAmplitude::printed
                                                              : LrpAmplitude::parts;
  options.color = params.text("color") == "coherent" ? LrpColor::coherent : LrpColor::independent;
  options.even_variance = params.text("variance") == "even";
  options.fixed.ratio = params.number("structure");
  options.fixed.reduced = params.text("reduction") == "blocks";
  options.fixed.turbulence = params.number("turbulence");
  options.fixed.placement = params.text("placement") == "random";
  options.footprint = params.number("footprint");
  return options;
}

std::span<const ParamSpec> lrp_params() {
  static const std::vector<ParamSpec> specs = {
      {.name = "cosines",
       .default_value = std::int64_t{50},
       .unit = "cosine",
       .help = "sum of those that each window of a stratum holds: nine times as many are evaluated at a point",
       .min = 1,
       .max = 4096},
      {.name = "strata",
       .default_value = std::int64_t{4},
       .unit = "",
       .help = "parts of equal energy that the spectrum is cut into; at most as many as cosines",
       .min = 1,
       .max = 64},
      {.name = "spacing",
       .default_value = 1.0,
       .unit = "",
       .help = "factor of the spacing of the windows' lattices, and so of the windows",
       .min = 0.05,
       .max = 20},
      {.name = "kept",
       .default_value = 0.99,
       .unit = "",
       .help = "part of the power that strata are cut from; 1, as in the paper, spreads the weakest stratum over all "
               "that is left of the spectrum",
       .min = 0.01,
       .max = 1},
      {.name = "structure",
       .default_value = 0.0,
       .unit = "",
       .help = "part of the power, that of the strongest bins, which keeps the phases of a block of the exemplar: 0 is "
               "noise, 1 the block itself, repeated",
       .min = 0,
       .max = 1},
      {.name = "reduction",
       .default_value = std::string("blocks"),
       .unit = "",
       .help = "of the structure: blocks: to its part of the cosines, in blocks as small as 1/256 of precision needs; "
               "none: all its bins, at the cost of as many cosines",
       .choices = {"blocks", "none"}},
      {.name = "turbulence",
       .default_value = 0.0,
       .unit = "pixel",
       .help = "standard deviation, along an axis, of where the structure is displaced to",
       .min = 0,
       .max = 1000},
      {.name = "placement",
       .default_value = std::string("fixed"),
       .unit = "",
       .help = "of the structure: fixed; or random: blocks of half its side are taken from anywhere in it",
       .choices = {"fixed", "random"}},
      {.name = "footprint",
       .default_value = 0.0,
       .unit = "pixel",
       .help = "side of the pixels that the noise is filtered for by clamping its frequencies; 0: values at points",
       .min = 0,
       .max = 65536},
      {.name = "color",
       .default_value = std::string("coherent"),
       .unit = "",
       .help = "coherent: waves of all channels share their phases, with colors drawn by the cross-spectrum; "
               "independent: as in the paper, a noise for each axis of a decorrelated color space, at as many times "
               "the cost",
       .choices = {"coherent", "independent"}},
      {.name = "amplitude",
       .default_value = std::string("corrected"),
       .unit = "",
       .help = "corrected: every stratum has its own variance; printed: by the paper's equation 3, which attenuates "
               "strata of wide windows; parts: every cosine has the variance of its own part of a stratum",
       .choices = {"corrected", "printed", "parts"}},
      {.name = "variance",
       .default_value = std::string("even"),
       .unit = "",
       .help = "even: sums are divided by the root of the squared windows' sum; lattice: as in the paper, where the "
               "variance varies by a factor of 2.4 over a cell of windows",
       .choices = {"even", "lattice"}},
      {.name = "window",
       .default_value = std::string("bessel"),
       .unit = "",
       .help = "bessel: the Bessel function I3; printed: the paper's series of five terms, which is another function",
       .choices = {"bessel", "printed"}},
      {.name = "block",
       .default_value = std::int64_t{0},
       .unit = "pixel",
       .help = "side of the blocks whose spectra are averaged, a power of two; 0: the largest one below the exemplar's "
               "sides",
       .min = 0,
       .max = 65536},
      {.name = "overlap",
       .default_value = 0.5,
       .unit = "",
       .help = "part of a side that neighboring blocks share at least",
       .min = 0,
       .max = 0.95},
      {.name = "taper",
       .default_value = std::string("hann"),
       .unit = "",
       .help = "of the blocks: hann; or none, whose borders leak into a cross",
       .choices = {"hann", "none"}}};
  return specs;
}

}  // namespace

MethodEntry lrp_entry() {
  return {
      .name = "lrp",
      .title = "Local random-phase noise",
      .reference = "Gilet, Sauvage, Vanhoey, Dischler, Ghazanfarpour, SIGGRAPH Asia 2014",
      .params = lrp_params(),
      .refuses = [](const Problem& problem, const Params& params, const Domain& domain) -> std::optional<std::string> {
        if (auto reason = refuse_domain(domain)) return reason;
        return refuse_lrp(problem.exemplar, lrp_options(params));
      },
      .analyze = [](const Problem& problem, const Params& params,
                    Seed seed) { return make_lrp(analyze_lrp(problem.exemplar, lrp_options(params), seed)); }};
}

}  // namespace textonbench
