#include "methods/spot/spline_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "methods/base/bspline.h"
#include "methods/base/parallel.h"
#include "methods/spot/spline_cost.h"
#include "methods/spot/spline_place.h"
#include "methods/spot/spline_points.h"
#include "methods/spot/spline_raster.h"
#include "methods/spot/spline_scale.h"
#include "methods/spot/spline_shader.h"
#include "methods/spot/spline_spectrum.h"

namespace textonbench {
namespace {

constexpr double furthest_coordinate = 0x1p40;

/// Points whose impacts are drawn together lie in squares of this side, in pixels.
constexpr double neighborhood = 16;

std::int64_t to_plane(double x) { return static_cast<std::int64_t>(std::floor(x * static_cast<double>(plane_unit))); }

void require_spline_texton(const SplineTexton& texton) {
  const Texton& coefficients = texton.coefficients;
  if (texton.order < 0 || texton.order > max_bspline_order) {
    throw std::invalid_argument(fmt::format("order = {}: expected 0 to {}", texton.order, max_bspline_order));
  }
  if (coefficients.kernels.empty() || coefficients.kernels.front().empty()) {
    throw std::invalid_argument("spline texton without coefficients: expected at least one");
  }
  for (const Image& kernel : coefficients.kernels) {
    if (kernel.extent() != coefficients.extent() || kernel.channels() != coefficients.channels()) {
      throw std::invalid_argument(fmt::format(
          "spline texton with coefficients of {}x{}x{} and {}x{}x{}: expected one size and number of channels",
          coefficients.extent().width, coefficients.extent().height, coefficients.channels(), kernel.width(),
          kernel.height(), kernel.channels()));
    }
    if (const auto place = find_non_finite(kernel)) {
      throw std::invalid_argument(fmt::format("spline texton with the coefficient {} at ({}, {}): expected finite ones",
                                              kernel.at(place->channel, place->x, place->y), place->x, place->y));
    }
  }
  if (coefficients.mean.size() != static_cast<std::size_t>(coefficients.channels()) ||
      !std::ranges::all_of(coefficients.mean, [](double m) { return std::isfinite(m); })) {
    throw std::invalid_argument(fmt::format("spline texton with {} means: expected {} finite numbers",
                                            coefficients.mean.size(), coefficients.channels()));
  }
  const auto box = static_cast<double>(reach(texton).area());
  if (!(texton.support_area > 0 && texton.support_area <= box)) {
    throw std::invalid_argument(
        fmt::format("spline texton with a support of {} pixels²: expected at most {}", texton.support_area, box));
  }
}

/// Cells of a Poisson process: the time of an evaluation is c (1 + r / a)² for the cells in reach and p MNI (1 + a /
/// r)² for their impacts, least at a / r = (c / (p MNI))^(1/3). c / p = 2 is measured by benchmarks/texton_noise_bench
/// for single points.
double best_cell(double mni) { return std::clamp(std::cbrt(2 / mni), 0.05, 1.0); }

class SplineNoise final : public Model, public Gaussian, public Procedural {
 public:
  SplineNoise(SplineTexton texton, const SplineNoiseOptions& options)
      : texton_(std::move(texton)),
        options_(options),
        grid_(spline_noise_impacts(texton_, options)),
        scale_(spline_noise_scale(texton_, options, grid_)),
        points_(texton_, scale_),
        framed_(frame_coefficients(texton_, scale_, grid_.mean_weight() == 0)),
        start_(spline_noise_start(texton_, scale_, grid_)) {}

  Image synthesize(const Domain& domain, Seed seed) const override {
    if (const auto reason = refuse_spline_noise(domain)) {
      throw std::invalid_argument(*reason);
    }
    const SplineRoute taken = route(domain);
    if (taken == SplineRoute::points) {
      return sum_by_point(domain, spline_noise_key(seed));
    }
    if (domain.step != 1) {
      throw std::invalid_argument(
          fmt::format("texton noise at a step of {} pixels: routes impacts and convolution expect a step of 1, "
                      "the route points takes any",
                      domain.step));
    }
    const RasterImpacts raster{
        grid_, spline_noise_key(seed), {to_plane(domain.origin.x), to_plane(domain.origin.y)}, domain.size};
    return taken == SplineRoute::impacts ? sum_by_impact(texton_, framed_, raster, start_)
                                         : sum_by_convolution(texton_, scale_, raster, texton_.coefficients.mean);
  }

  void evaluate(std::span<const Point2> points, Seed seed, std::span<float> out) const override {
    require_points(points, out, channels());
    sum_at(points, spline_noise_key(seed), Derivative::none, out);
    for (int c = 0; c < channels(); ++c) {
      for (float& v : out.subspan(static_cast<std::size_t>(c) * points.size(), points.size())) {
        v += start_[static_cast<std::size_t>(c)];
      }
    }
  }
  int smoothness() const override { return texton_.order; }
  void gradient(std::span<const Point2> points, Seed seed, std::span<float> out) const override {
    if (texton_.order == 0) {
      throw std::invalid_argument("gradient of texton noise of order 0: expected an order of at least 1");
    }
    require_points(points, out, 2 * channels());
    sum_at(points, spline_noise_key(seed), Derivative::x, out.first(out.size() / 2));
    sum_at(points, spline_noise_key(seed), Derivative::y, out.subspan(out.size() / 2));
  }

  const SplineNoiseOptions& options() const { return options_; }
  const Gaussian* gaussian() const override { return options_.share ? nullptr : this; }
  const Procedural* procedural() const override { return this; }
  const SplineTexton* spline_texton() const override { return &texton_; }
  std::optional<ShaderRecipe> shader(const ShaderRequest& request) const override {
    return spline_noise_recipe(texton_, options_, request);
  }
  std::vector<double> mean() const override { return texton_.coefficients.mean; }
  CrossSpectrum spectrum(Extent grid) const override { return spline_spectrum(texton_, grid); }

  Footprint footprint(const Domain& domain) const override {
    std::size_t bytes = 0;
    for (const Image& kernel : texton_.coefficients.kernels) {
      bytes += kernel.bytes();
    }
    return {bytes, cost(route(domain), domain).operations};
  }

 private:
  int channels() const { return texton_.coefficients.channels(); }

  static void require_points(std::span<const Point2> points, std::span<const float> out, int planes) {
    if (out.size() != points.size() * static_cast<std::size_t>(planes)) {
      throw std::invalid_argument(fmt::format("{} points of texton noise into {} numbers: expected {} a point",
                                              points.size(), out.size(), planes));
    }
    for (const Point2& p : points) {
      if (!(std::abs(p.x) <= furthest_coordinate && std::abs(p.y) <= furthest_coordinate)) {
        throw std::invalid_argument(
            fmt::format("texton noise at ({}, {}): expected a point within 2^40 pixels of the origin", p.x, p.y));
      }
    }
  }

  /// Sums, without start, of runs of points that lie in one neighborhood.
  void sum_at(std::span<const Point2> points, std::uint64_t key, Derivative derivative, std::span<float> out) const {
    constexpr std::size_t block = 1024;
    parallel_for(static_cast<int>((points.size() + block - 1) / block), [&](int i) {
      const std::size_t end = std::min(points.size(), (static_cast<std::size_t>(i) + 1) * block);
      std::vector<PlanePoint> run;
      AlignedBuffer<float> sums;
      for (std::size_t first = static_cast<std::size_t>(i) * block; first < end; first += run.size()) {
        run = run_of(points.subspan(first, end - first));
        points_.sum(grid_, key, run, derivative, sums);
        for (std::size_t k = 0; k < run.size(); ++k) {
          for (int c = 0; c < channels(); ++c) {
            out[static_cast<std::size_t>(c) * points.size() + first + k] =
                sums.data()[k * static_cast<std::size_t>(points_.lanes()) + static_cast<std::size_t>(c)];
          }
        }
      }
    });
  }

  /// The first points, as many as lie in one neighborhood.
  static std::vector<PlanePoint> run_of(std::span<const Point2> points) {
    const auto [left, top] = points.front();
    std::vector<PlanePoint> run;
    for (const Point2& p : points) {
      if (std::abs(p.x - left) > neighborhood || std::abs(p.y - top) > neighborhood) {
        break;
      }
      run.push_back({to_plane(p.x), to_plane(p.y)});
    }
    return run;
  }

  Image sum_by_point(const Domain& domain, std::uint64_t key) const {
    const int width = domain.size.width;
    const int height = domain.size.height;
    const int side = static_cast<int>(std::clamp(neighborhood / domain.step, 1.0, 32.0));
    const int columns = (width + side - 1) / side;
    Image out = Image::uninitialized(domain.size, channels());
    parallel_for((height + side - 1) / side, [&](int band) {
      std::vector<PlanePoint> tile;
      AlignedBuffer<float> sums;
      const int top = band * side;
      const int bottom = std::min(top + side, height);
      for (int column = 0; column < columns; ++column) {
        const int left = column * side;
        const int right = std::min(left + side, width);
        tile.clear();
        for (int y = top; y < bottom; ++y) {
          for (int x = left; x < right; ++x) {
            tile.push_back({to_plane(domain.origin.x + domain.step * x), to_plane(domain.origin.y + domain.step * y)});
          }
        }
        points_.sum(grid_, key, tile, Derivative::none, sums);
        for (int c = 0; c < channels(); ++c) {
          const float* from = sums.data() + c;
          for (int y = top; y < bottom; ++y) {
            for (int x = left; x < right; ++x, from += points_.lanes()) {
              out.at(c, x, y) = *from + start_[static_cast<std::size_t>(c)];
            }
          }
        }
      }
    });
    return out;
  }

  SplineCost cost(SplineRoute taken, const Domain& domain) const {
    return taken == SplineRoute::points    ? cost_by_point(texton_, grid_.intensity())
           : taken == SplineRoute::impacts ? cost_by_impact(texton_, grid_.intensity(), domain)
                                           : cost_by_convolution(texton_, grid_.intensity(), domain);
  }

  SplineRoute route(const Domain& domain) const {
    if (options_.route != SplineRoute::automatic) {
      return options_.route;
    }
    if (domain.step != 1) {
      return SplineRoute::points;
    }
    SplineRoute best = SplineRoute::impacts;
    for (const SplineRoute other : {SplineRoute::convolution, SplineRoute::points}) {
      best = cost(other, domain).nanoseconds < cost(best, domain).nanoseconds ? other : best;
    }
    return best;
  }

  SplineTexton texton_;
  SplineNoiseOptions options_;
  ImpactGrid grid_;
  double scale_;
  SplinePoints points_;
  std::vector<Image> framed_;
  std::vector<float> start_;
};

}  // namespace

ImpactGrid spline_noise_impacts(const SplineTexton& texton, const SplineNoiseOptions& options) {
  require_spline_texton(texton);
  if (!(std::isfinite(options.mni) && options.mni > 0)) {
    throw std::invalid_argument(fmt::format("mni = {}: expected a finite mean number of impacts above 0", options.mni));
  }
  if (!(options.cell == 0 || (options.cell >= 0.01 && options.cell <= 16))) {
    throw std::invalid_argument(
        fmt::format("cell = {}: expected 0.01 to 16 sides of the support, or 0 for the fastest", options.cell));
  }
  const double paper_cell = 0.6;
  const double fallback = options.impacts == ImpactProcess::paper ? paper_cell : best_cell(options.mni);
  const double cell = options.cell > 0 ? options.cell : fallback;
  ImpactGrid grid(options.impacts, options.mni / texton.support_area, cell * std::sqrt(texton.support_area),
                  static_cast<int>(texton.coefficients.kernels.size()));
  if (options.share) {
    if (grid.mean_weight() != 0) {
      throw std::invalid_argument("kernels chosen by place: expected impacts of random sign");
    }
    const Extent box = texton.coefficients.extent();
    const auto kernels = static_cast<int>(texton.coefficients.kernels.size());
    grid.choose_kernels([share = *options.share, box, kernels](std::int64_t x, std::int64_t y) {
      return kernel_with_corner(share, x, y, box, kernels);
    });
  }
  return grid;
}

std::uint64_t spline_noise_key(Seed seed) { return Stream(seed).child("texton noise").key(); }

std::unique_ptr<Model> make_spline_noise(SplineTexton texton, const SplineNoiseOptions& options) {
  return std::make_unique<SplineNoise>(std::move(texton), options);
}

const SplineNoiseOptions* spline_noise_of(const Model& model) {
  const auto* noise = dynamic_cast<const SplineNoise*>(&model);
  return noise == nullptr ? nullptr : &noise->options();
}

std::optional<std::string> refuse_spline_noise(const Domain& domain) {
  if (domain.periodic) {
    return "texton noise on a torus: its impacts are those of the plane; expected a domain that is not periodic";
  }
  if (!(std::isfinite(domain.step) && domain.step > 0)) {
    return fmt::format("texton noise at a step of {} pixels: expected a finite number above 0", domain.step);
  }
  const Point2 last{domain.origin.x + domain.step * (domain.size.width - 1.0),
                    domain.origin.y + domain.step * (domain.size.height - 1.0)};
  for (const Point2& corner : {domain.origin, last}) {
    if (!(std::abs(corner.x) <= furthest_coordinate && std::abs(corner.y) <= furthest_coordinate)) {
      return fmt::format("texton noise at ({}, {}): expected pixels within 2^40 of the origin", corner.x, corner.y);
    }
  }
  return std::nullopt;
}

}  // namespace textonbench
