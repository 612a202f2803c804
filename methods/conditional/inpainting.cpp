#include "methods/conditional/inpainting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace textonbench {
namespace {

void require_some_missing(const Image& u, const Mask& missing) {
  if (missing.extent() != u.extent()) {
    throw std::invalid_argument(fmt::format("a mask of {}x{} for a picture of {}x{}: expected the same size",
                                            missing.extent().width, missing.extent().height, u.width(), u.height()));
  }
  if (missing.count() == 0) throw std::invalid_argument("no pixel is missing: expected a mask that is not empty");
  if (missing.count() == u.extent().area()) {
    throw std::invalid_argument("every pixel is missing: expected a mask that leaves some");
  }
}

/// The picture with zeros where it is missing. Throws for a known sample that is not finite.
Image known_part(const Image& u, const Mask& missing) {
  Image result = u;
  for (int c = 0; c < u.channels(); ++c) {
    for (int y = 0; y < u.height(); ++y) {
      for (int x = 0; x < u.width(); ++x) {
        if (missing.at(x, y)) {
          result.at(c, x, y) = 0;
        } else if (!std::isfinite(u.at(c, x, y))) {
          throw std::invalid_argument(fmt::format(
              "channel {} of the known pixel ({}, {}) is {}: expected a finite number", c + 1, x, y, u.at(c, x, y)));
        }
      }
    }
  }
  return result;
}

GaussianField field_in(const Image& u, const Mask& missing, const Rectangle& part) {
  if (part.x < 0 || part.y < 0 || part.size.width < 1 || part.size.height < 1 || part.x > u.width() - part.size.width ||
      part.y > u.height() - part.size.height) {
    throw std::invalid_argument(fmt::format("a clean part {},{},{},{} of a picture of {}x{}: expected one inside it",
                                            part.x, part.y, part.size.width, part.size.height, u.width(), u.height()));
  }
  Mask in_part(part.size);
  for (int y = 0; y < part.size.height; ++y) {
    for (int x = 0; x < part.size.width; ++x) in_part.set(x, y, missing.at(part.x + x, part.y + y));
  }
  return estimate_field(crop(u, part.x, part.y, part.size), in_part);
}

GaussianField model_of(const Image& u, const Mask& missing, const Exemplar* other, const InpaintingOptions& options) {
  if (other != nullptr && options.clean) {
    throw std::invalid_argument("both another exemplar and a clean part to estimate the model from: expected one");
  }
  if (!(options.nugget >= 0)) {
    throw std::invalid_argument(fmt::format("nugget = {}: expected 0 or more", options.nugget));
  }
  GaussianField field;
  if (other != nullptr) {
    if (other->pixels.channels() != u.channels()) {
      throw std::invalid_argument(
          fmt::format("a picture of {} channels and the exemplar {} of {}: expected the same number", u.channels(),
                      other->name, other->pixels.channels()));
    }
    field = estimate_field(other->pixels, Mask(other->pixels.extent()));
  } else {
    field = options.clean ? field_in(u, missing, *options.clean) : estimate_field(u, missing);
  }
  field.periodic = options.periodic;
  field.nugget_variance = options.nugget * mean_variance(field);
  return field;
}

Mask border_of(const Mask& missing, const InpaintingOptions& options) {
  if (options.border < 1) {
    throw std::invalid_argument(fmt::format("a border of {} pixels: expected at least 1", options.border));
  }
  return difference(dilate(missing, options.border, options.periodic), missing);
}

}  // namespace

Inpainting::Inpainting(const Image& u, const Mask& missing, const Exemplar* other, const InpaintingOptions& options)
    : options_((require_some_missing(u, missing), options)),
      picture_(known_part(u, missing)),
      missing_(missing),
      conditioning_(border_of(missing, options)),
      operator_(model_of(picture_, missing, other, options), conditioning_, missing),
      system_(operator_, options.solve) {}

std::vector<double> Inpainting::right_side() const {
  std::vector<double> values;
  values.reserve(operator_.unknowns());
  for (int c = 0; c < operator_.channels(); ++c) {
    const double mean = operator_.field().mean[static_cast<std::size_t>(c)];
    for (const Pixel& p : operator_.conditioning_pixels()) {
      values.push_back(static_cast<double>(picture_.at(c, p.x, p.y)) - mean);
    }
  }
  return values;
}

Image Inpainting::filled(std::span<const double> values) const {
  Image result = picture_;
  std::size_t i = 0;
  for (int c = 0; c < operator_.channels(); ++c) {
    const double mean = operator_.field().mean[static_cast<std::size_t>(c)];
    for (const Pixel& p : operator_.missing_pixels()) result.at(c, p.x, p.y) = static_cast<float>(mean + values[i++]);
  }
  return result;
}

Inpainting::Sample Inpainting::sample(Seed seed, const SolveObserver& observer) const {
  const KrigingOperator::Values f = operator_.simulate(seed);
  std::vector<double> b = right_side();
  std::ranges::transform(b, f.conditioning, b.begin(), std::minus<>());
  KrigingSystem::Solution solution = system_.solve(b, observer);
  std::vector<double> values = operator_.extend(solution.k);
  std::ranges::transform(values, f.missing, values.begin(), std::plus<>());
  return {filled(values), solution.summary};
}

Inpainting::Sample Inpainting::kriging_sample(const SolveObserver& observer) const {
  const KrigingSystem::Solution solution = system_.solve(right_side(), observer);
  return {filled(operator_.extend(solution.k)), solution.summary};
}

const KrigingSystem::Solution& Inpainting::kriging_solution() const {
  std::call_once(solved_, [&] { solution_ = system_.solve(right_side()); });
  return solution_;
}

Image Inpainting::kriging() const { return filled(operator_.extend(kriging_solution().k)); }

Image Inpainting::innovation(Seed seed) const {
  const KrigingOperator::Values f = operator_.simulate(seed);
  const std::vector<double> estimate = operator_.extend(system_.solve(f.conditioning).k);
  Image result(picture_.extent(), picture_.channels());
  std::size_t i = 0;
  for (int c = 0; c < operator_.channels(); ++c) {
    for (const Pixel& p : operator_.missing_pixels()) {
      result.at(c, p.x, p.y) = static_cast<float>(f.missing[i] - estimate[i]);
      ++i;
    }
  }
  return result;
}

Image Inpainting::unconditional(Seed seed) const {
  const KrigingOperator::Values f = operator_.simulate(seed);
  return filled(f.missing);
}

Image Inpainting::synthesize(const Domain& domain, Seed seed) const {
  if (const auto reason = refuse_other_raster(picture_.extent(), domain)) throw std::invalid_argument(*reason);
  return sample(seed).image;
}

/// Of an iterative solver the transforms of 20 iterations, of a dense one its substitutions, spread over all pixels.
Footprint Inpainting::footprint(const Domain& domain) const {
  constexpr double iterations = 20;
  const auto unknowns = static_cast<double>(operator_.unknowns());
  const auto grid = static_cast<double>(operator_.covariance().grid().area());
  const double apply = operator_.channels() * (5 * std::log2(grid) + 12) * grid;
  const double solve = system_.solver() == KrigingSolver::dense ? 2 * unknowns * unknowns : iterations * apply;
  return {operator_.bytes() + system_.bytes() + picture_.bytes(),
          (solve + 2 * apply) / static_cast<double>(domain.size.area())};
}

}  // namespace textonbench
