#include "methods/spot/surface_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <utility>

#include "methods/base/mesh.h"
#include "methods/base/surface_view.h"
#include "methods/spot/spline_spectrum.h"
#include "methods/spot/surface_shader.h"
#include "methods/spot/surface_sum.h"
#include "methods/spot/texton_noise.h"

namespace textonbench {
namespace {

std::span<const ParamSpec> surface_noise_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = texton_fit_params();
    all.push_back({.name = "surface",
                   .default_value = std::string("torus"),
                   .unit = "",
                   .help = "plane: z = 0, where the noise has the law of texton_noise; sphere and torus: a picture of "
                           "one; mesh: a picture of the mesh that the option mesh names",
                   .choices = {"plane", "sphere", "torus", "mesh"}});
    all.push_back({.name = "mesh",
                   .default_value = std::string(),
                   .unit = "file",
                   .help = "Wavefront OBJ file, drawn with its z axis up, as large as the picture allows"});
    all.push_back({.name = "tilt",
                   .default_value = 35.0,
                   .unit = "degree",
                   .help = "height of the viewer above the plane of x and y",
                   .min = -90,
                   .max = 90});
    all.push_back({.name = "impacts",
                   .default_value = std::string("stratified"),
                   .unit = "",
                   .help = "one of random sign in each cube of a lattice (stratified), or the points of a Poisson "
                           "process, which takes about three times as many to look as Gaussian",
                   .choices = {"poisson", "stratified"}});
    all.push_back({.name = "mni",
                   .default_value = 20.0,
                   .unit = "impact",
                   .help = "mean number of impacts whose kernels reach a point; the paper takes 60 of poisson impacts",
                   .min = 1e-3,
                   .max = 1e4});
    return all;
  }();
  return specs;
}

/// A point to draw: a pixel and how bright the noise shows there.
struct DrawnPoint {
  int x = 0, y = 0;
  float brightness = 1;
  SurfacePoint point;
};

std::vector<DrawnPoint> points_of_plane(const Domain& domain) {
  std::vector<DrawnPoint> points;
  points.reserve(static_cast<std::size_t>(domain.size.area()));
  for (int y = 0; y < domain.size.height; ++y) {
    for (int x = 0; x < domain.size.width; ++x) {
      DrawnPoint& drawn = points.emplace_back(DrawnPoint{.x = x, .y = y, .point = {}});
      drawn.point.position = {domain.origin.x + domain.step * x, domain.origin.y + domain.step * y, 0};
    }
  }
  return points;
}

std::vector<DrawnPoint> points_of_mesh(const TriangleMesh& mesh, const Domain& domain, double tilt) {
  std::vector<DrawnPoint> points;
  for (const ViewedPoint& seen : view_mesh(mesh, domain.size, picture_radius(domain.size), tilt)) {
    const auto brightness = static_cast<float>(0.25 + 0.75 * seen.facing);
    DrawnPoint& drawn =
        points.emplace_back(DrawnPoint{.x = seen.x, .y = seen.y, .brightness = brightness, .point = seen.point});
    drawn.point.position *= domain.step;
  }
  return points;
}

std::optional<std::string> refuse_surface_domain(bool plane, const Domain& domain) {
  if (domain.periodic) {
    return "surface noise on a torus of pixels: its impacts are those of space; expected a domain that is not periodic";
  }
  if (!plane && domain.origin != Point2{}) {
    return fmt::format("a picture of a surface starts at (0, 0), but ({}, {}) was asked for", domain.origin.x,
                       domain.origin.y);
  }
  if (auto reason = refuse_spline_noise(domain)) {
    return reason;
  }
  const double furthest =
      std::max({std::abs(domain.origin.x), std::abs(domain.origin.x + domain.step * domain.size.width),
                std::abs(domain.origin.y), std::abs(domain.origin.y + domain.step * domain.size.height)});
  if (furthest > SurfaceSum::furthest_coordinate) {
    return fmt::format("surface noise {} pixels from the origin: expected points within {}", furthest,
                       SurfaceSum::furthest_coordinate);
  }
  return std::nullopt;
}

class SurfaceNoise final : public Model, public Gaussian {
 public:
  /// The plane when there is no mesh.
  SurfaceNoise(SplineTexton texton, const SurfaceSumOptions& options, std::shared_ptr<const TriangleMesh> mesh,
               double tilt)
      : sum_(std::move(texton), options), mni_(options.mni), mesh_(std::move(mesh)), tilt_(tilt) {}

  Image synthesize(const Domain& domain, Seed seed) const override {
    if (const auto reason = refuse_surface_domain(!mesh_, domain)) {
      throw std::invalid_argument(*reason);
    }
    std::vector<DrawnPoint> drawn = mesh_ ? points_of_mesh(*mesh_, domain, tilt_) : points_of_plane(domain);
    // Tile by tile, so that consecutive points are near to each other.
    const int side = std::max(1, static_cast<int>(sum_.thickness() / (4 * domain.step)));
    std::ranges::stable_sort(drawn, {}, [&](const DrawnPoint& p) { return std::pair{p.y / side, p.x / side}; });
    std::vector<SurfacePoint> points;
    points.reserve(drawn.size());
    std::ranges::transform(drawn, std::back_inserter(points), &DrawnPoint::point);

    const std::vector<double>& means = sum_.texton().coefficients.mean;
    std::vector<float> values(points.size() * means.size());
    sum_.evaluate(points, seed, values);
    Image picture = Image::uninitialized(domain.size, static_cast<int>(means.size()));
    for (int c = 0; c < picture.channels(); ++c) {
      for (int y = 0; y < picture.height(); ++y) {
        std::ranges::fill(picture.row(c, y), 1.0F);
      }
      const float* value = values.data() + static_cast<std::size_t>(c) * points.size();
      for (const DrawnPoint& p : drawn) {
        picture.at(c, p.x, p.y) = p.brightness * *value++;
      }
    }
    return picture;
  }

  const Gaussian* gaussian() const override { return mesh_ ? nullptr : this; }
  std::vector<double> mean() const override { return sum_.texton().coefficients.mean; }
  CrossSpectrum spectrum(Extent grid) const override { return spline_spectrum(sum_.texton(), grid); }

  std::optional<ShaderRecipe> shader(const ShaderRequest& request) const override {
    ShaderRecipe recipe = surface_noise_recipe(sum_, request);
    recipe.mesh = mesh_;
    recipe.tilt = tilt_;
    return recipe;
  }

  Footprint footprint(const Domain&) const override {
    std::size_t bytes = 0;
    for (const Image& kernel : sum_.texton().coefficients.kernels) {
      bytes += kernel.bytes();
    }
    const double taps = sum_.texton().order + 1.0;
    const double channels = static_cast<double>(sum_.texton().coefficients.mean.size());
    constexpr double projection = 18;  // three inner products and the weight
    return {bytes, mni_ * (projection + 2 * taps * taps * channels)};
  }

 private:
  SurfaceSum sum_;
  double mni_;
  std::shared_ptr<const TriangleMesh> mesh_;
  double tilt_;
};

std::optional<std::string> refuse_surface_noise(const Problem& problem, const Params& params, const Domain& domain) {
  if (auto reason = refuse_texton_fit(problem, params)) {
    return reason;
  }
  const std::string& surface = params.text("surface");
  const bool named = !params.text("mesh").empty();
  if ((surface == "mesh") != named) {
    return named ? fmt::format("mesh = {} with surface = {}: expected surface = mesh", params.text("mesh"), surface)
                 : "surface = mesh needs an OBJ file: -p mesh=FILE";
  }
  return refuse_surface_domain(surface == "plane", domain);
}

std::shared_ptr<const TriangleMesh> mesh_of(const Params& params) {
  const std::string& surface = params.text("surface");
  if (surface == "plane") return nullptr;
  return std::make_shared<const TriangleMesh>(surface == "mesh" ? read_obj(params.text("mesh")) : solid_mesh(surface));
}

}  // namespace

MethodEntry surface_noise_entry() {
  return {.name = "surface_noise",
          .title = "Texton noise on a surface",
          .reference = "Galerne, Leclaire, Moisan, CGF 2017, Section 6",
          .params = surface_noise_params(),
          .refuses = refuse_surface_noise,
          .analyze = [](const Problem& problem, const Params& params, Seed seed) -> std::unique_ptr<Model> {
            require_usable(problem.exemplar);
            std::shared_ptr<const TriangleMesh> mesh = mesh_of(params);
            const SurfaceSumOptions options{
                .impacts = params.text("impacts") == "poisson" ? ImpactProcess::poisson : ImpactProcess::stratified,
                .mni = params.number("mni")};
            return std::make_unique<SurfaceNoise>(fit_texton_noise(problem.exemplar, params, seed), options,
                                                  std::move(mesh), params.number("tilt") * std::numbers::pi / 180);
          }};
}

}  // namespace textonbench
