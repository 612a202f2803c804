#include "methods/spot/filtered_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <utility>

#include "methods/base/ground_view.h"
#include "methods/base/parallel.h"
#include "methods/spot/filtered_sum.h"
#include "methods/spot/texton_filter.h"
#include "methods/spot/texton_noise.h"

namespace textonbench {
namespace {

constexpr int supersampling = 20;  ///< evaluations along a side of a pixel
constexpr double sky = 1;          ///< beyond the ground
constexpr double longest_pixel = 256;

std::span<const ParamSpec> filtered_noise_params() {
  static const std::vector<ParamSpec> specs = [] {
    std::vector<ParamSpec> all = texton_fit_params();
    std::ranges::copy(spline_impacts_params(), std::back_inserter(all));
    all.push_back({.name = "filter",
                   .default_value = std::string("anisotropic"),
                   .unit = "",
                   .help =
                       "none; trilinear: one probe of the texton's mip chain; anisotropic: up to 16 along the longer "
                       "side of a pixel; ewa: Gaussian sum over an ellipse of coefficients; supersampled: mean of "
                       "20 x 20 unfiltered values",
                   .choices = {"none", "trilinear", "anisotropic", "ewa", "supersampled"}});
    all.push_back({.name = "window",
                   .default_value = std::string("footprint"),
                   .unit = "",
                   .help =
                       "impacts that a pixel visits: all that the filtered texton reaches (footprint), or those that "
                       "the unfiltered one reaches, which cuts it short (kernel)",
                   .choices = {"footprint", "kernel"}});
    all.push_back({.name = "view",
                   .default_value = std::string("ground"),
                   .unit = "",
                   .help =
                       "ground: a plane in perspective, white beyond it; plane: seen from above, a pixel as large as "
                       "the step",
                   .choices = {"ground", "plane"}});
    all.push_back({.name = "height",
                   .default_value = 64.0,
                   .unit = "pixel",
                   .help = "of the camera above the ground, in pixels of the exemplar",
                   .min = 1e-3,
                   .max = 1e6});
    all.push_back({.name = "pitch",
                   .default_value = 20.0,
                   .unit = "degree",
                   .help = "of the line of sight below the horizon",
                   .min = 1,
                   .max = 89});
    all.push_back({.name = "field",
                   .default_value = 60.0,
                   .unit = "degree",
                   .help = "horizontal angle of view",
                   .min = 1,
                   .max = 170});
    all.push_back({.name = "furthest",
                   .default_value = 64.0,
                   .unit = "pixel",
                   .help = "longest side of a pixel on the ground, in pixels of the exemplar, that is still drawn",
                   .min = 1e-3,
                   .max = longest_pixel});
    return all;
  }();
  return specs;
}

struct FilteredNoiseOptions {
  TextonFilter filter = TextonFilter::anisotropic;
  bool supersampled = false;  ///< in place of the filter
  ImpactWindow window = ImpactWindow::footprint;
  bool ground = true;  ///< the plane seen from above otherwise
  GroundViewOptions view{};
};

TextonFilter texton_filter_named(const std::string& name) {
  return name == "trilinear"     ? TextonFilter::trilinear
         : name == "anisotropic" ? TextonFilter::anisotropic
         : name == "ewa"         ? TextonFilter::ewa
                                 : TextonFilter::none;
}

FilteredNoiseOptions filtered_noise_options(const Params& params) {
  constexpr double degree = std::numbers::pi / 180;
  return {.filter = texton_filter_named(params.text("filter")),
          .supersampled = params.text("filter") == "supersampled",
          .window = params.text("window") == "kernel" ? ImpactWindow::kernel : ImpactWindow::footprint,
          .ground = params.text("view") == "ground",
          .view = {.height = params.number("height"),
                   .pitch = params.number("pitch") * degree,
                   .field = params.number("field") * degree,
                   .furthest = params.number("furthest")}};
}

/// Of a picture whose pixels are at most `furthest` long on the ground, at a step of 1.
std::optional<std::string> refuse_filtered_domain(bool ground, double furthest, const Domain& domain) {
  if (ground && domain.origin != Point2{}) {
    return fmt::format("a view of the ground starts at (0, 0), but ({}, {}) was asked for", domain.origin.x,
                       domain.origin.y);
  }
  if (auto reason = refuse_spline_noise(domain)) {
    return reason;
  }
  const double longest = domain.step * (ground ? furthest : 1);
  if (longest > longest_pixel) {
    return fmt::format("a pixel {} pixels of the exemplar long: filters serve up to {}", longest, longest_pixel);
  }
  return std::nullopt;
}

/// The plane seen from above.
class PlaneView {
 public:
  explicit PlaneView(const Point2& origin) : origin_(origin.x, origin.y) {}
  static bool covers(double, double) { return true; }
  Eigen::Vector2d point(double x, double y) const { return origin_ + Eigen::Vector2d(x, y); }
  static Eigen::Matrix2d footprint(double, double) { return Eigen::Matrix2d::Identity(); }

 private:
  Eigen::Vector2d origin_;
};

template <class Body>
auto with_view(const FilteredNoiseOptions& options, const Domain& domain, const Body& body) {
  return options.ground ? body(GroundView(domain.size, options.view))
                        : body(PlaneView({domain.origin.x / domain.step, domain.origin.y / domain.step}));
}

class FilteredNoise final : public Model {
 public:
  FilteredNoise(std::shared_ptr<const FilteredSum> sum, const FilteredNoiseOptions& options)
      : sum_(std::move(sum)), options_(options) {}

  Image synthesize(const Domain& domain, Seed seed) const override {
    if (const auto reason = refuse_filtered_domain(options_.ground, options_.view.furthest, domain)) {
      throw std::invalid_argument(*reason);
    }
    return with_view(options_, domain, [&](const auto& view) { return draw(view, domain, seed); });
  }

  const SplineTexton* spline_texton() const override { return &sum_->texton(); }

  std::unique_ptr<Model> reference() const override {
    if (options_.supersampled) {
      return nullptr;
    }
    FilteredNoiseOptions supersampled = options_;
    supersampled.supersampled = true;
    return std::make_unique<FilteredNoise>(sum_, supersampled);
  }

  Footprint footprint(const Domain& domain) const override {
    return {sum_->bytes(), with_view(options_, domain, [&](const auto& view) { return operations(view, domain); })};
  }

 private:
  /// Mean over the pixels of the picture.
  template <class View>
  double operations(const View& view, const Domain& domain) const {
    const TextonFilter filter = options_.supersampled ? TextonFilter::none : options_.filter;
    const double samples = options_.supersampled ? supersampling * supersampling : 1;
    double sum = 0;
    for (int y = 0; y < domain.size.height; ++y) {
      for (int x = 0; x < domain.size.width; ++x) {
        if (view.covers(x, y)) sum += sum_->operations(domain.step * view.footprint(x, y), filter, options_.window);
      }
    }
    return samples * sum / static_cast<double>(domain.size.area());
  }

  template <class View>
  Image draw(const View& view, const Domain& domain, Seed seed) const {
    const std::uint64_t key = spline_noise_key(seed);
    Image picture = Image::uninitialized(domain.size, sum_->texton().coefficients.channels());
    parallel_for(picture.height(), [&](int y) {
      std::vector<PlaneImpact> impacts;
      for (int x = 0; x < picture.width(); ++x) {
        const bool covered = view.covers(x, y);
        const Eigen::Vector4d value =
            covered ? pixel(view, domain.step, {x, y}, key, impacts) : Eigen::Vector4d::Constant(sky);
        for (int c = 0; c < picture.channels(); ++c) {
          picture.at(c, x, y) = static_cast<float>(value[c]);
        }
      }
    });
    return picture;
  }

  template <class View>
  Eigen::Vector4d pixel(const View& view, double step, const Eigen::Vector2d& center, std::uint64_t key,
                        std::vector<PlaneImpact>& impacts) const {
    const Eigen::Matrix2d footprint = step * view.footprint(center.x(), center.y());
    const auto at = [&](double x, double y, TextonFilter filter) {
      return sum_->evaluate(step * view.point(x, y), footprint, filter, options_.window, key, impacts);
    };
    if (!options_.supersampled) {
      return at(center.x(), center.y(), options_.filter);
    }
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int j = 0; j < supersampling; ++j) {
      for (int i = 0; i < supersampling; ++i) {
        sum += at(center.x() + (i + 0.5) / supersampling - 0.5, center.y() + (j + 0.5) / supersampling - 0.5,
                  TextonFilter::none);
      }
    }
    return sum / (supersampling * supersampling);
  }

  std::shared_ptr<const FilteredSum> sum_;
  FilteredNoiseOptions options_;
};

std::optional<std::string> refuse_filtered_noise(const Problem& problem, const Params& params, const Domain& domain) {
  if (auto reason = refuse_texton_fit(problem, params)) {
    return reason;
  }
  if (const int channels = problem.exemplar.pixels.channels(); channels > MipChain::max_channels) {
    return fmt::format("filtered_noise has mip chains of at most {} channels: \"{}\" has {}", MipChain::max_channels,
                       problem.exemplar.name, channels);
  }
  if (params.integer("order") != 1) {
    return fmt::format("order = {}: mip chains are of bilinear kernels, expected 1", params.integer("order"));
  }
  return refuse_filtered_domain(params.text("view") == "ground", params.number("furthest"), domain);
}

}  // namespace

MethodEntry filtered_noise_entry() {
  return {.name = "filtered_noise",
          .title = "Texton noise filtered in perspective",
          .reference = "Galerne, Leclaire, Moisan, CGF 2017, Section 5",
          .params = filtered_noise_params(),
          .refuses = refuse_filtered_noise,
          .analyze = [](const Problem& problem, const Params& params, Seed seed) -> std::unique_ptr<Model> {
            require_usable(problem.exemplar);
            return std::make_unique<FilteredNoise>(
                std::make_shared<FilteredSum>(fit_texton_noise(problem.exemplar, params, seed),
                                              spline_impacts_options(params)),
                filtered_noise_options(params));
          }};
}

}  // namespace textonbench
