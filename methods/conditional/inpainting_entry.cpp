// The catalogue's row of inpainting: options and what is refused.
#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "methods/base/masks.h"
#include "methods/conditional/inpainting.h"

namespace textonbench {
namespace {

std::span<const ParamSpec> inpainting_params() {
  static const std::vector<ParamSpec> specs = {
      {.name = "mask",
       .default_value = std::string("square"),
       .unit = "mask",
       .help = "missing pixels: square (in the middle), holes, ragged, pixels, lines (of `missing` percent in all), "
               "rect:x,y,w,h (or several, separated by ;), or a picture whose non-zero pixels are missing"},
      {.name = "missing",
       .default_value = 10.0,
       .unit = "percent",
       .help = "how much is missing, where the mask is one of the named shapes",
       .min = 0.001,
       .max = 99},
      {.name = "border",
       .default_value = std::int64_t{3},
       .unit = "pixel",
       .help = "known pixels within this distance of a missing one are conditioned on",
       .min = 1,
       .max = 1 << 20},
      {.name = "covariance",
       .default_value = std::string("plane"),
       .unit = "",
       .help = "plane: aperiodic autocorrelation of the spot; torus: periodic, on a torus of the picture's size",
       .choices = {"plane", "torus"}},
      {.name = "model",
       .default_value = std::string(),
       .unit = "exemplar",
       .help = "the exemplar that the model is estimated from, instead of the picture's known pixels"},
      {.name = "clean",
       .default_value = std::string(),
       .unit = "pixel",
       .help = "x,y,w,h: the model is estimated from the known pixels of this part of the picture"},
      {.name = "nugget",
       .default_value = 0.0,
       .unit = "1",
       .help = "variance of white noise in the model and its samples, over the mean variance of the channels",
       .min = 0},
      {.name = "solver",
       .default_value = std::string("auto"),
       .unit = "",
       .help =
           "of the kriging system: auto (dense up to 1000 unknowns, schwarz above), dense (Cholesky), cg (conjugate "
           "gradient), schwarz or circulant (cg with that preconditioner), normal (cg on the normal equations)",
       .choices = {"auto", "dense", "cg", "schwarz", "circulant", "normal"}},
      {.name = "tolerance",
       .default_value = 1e-6,
       .unit = "1",
       .help = "residual at which an iterative solver stops, relative to the right side",
       .min = 0,
       .max = 1},
      {.name = "iterations",
       .default_value = std::int64_t{1000},
       .unit = "iteration",
       .help = "an iterative solver stops after so many at the latest",
       .min = 1,
       .max = 1 << 30}};
  return specs;
}

std::optional<std::string> refuse(const Problem& problem, const Params&, const Domain& domain) {
  if (problem.observed == nullptr) return "inpainting needs a mask of what is missing, and has none";
  return refuse_other_raster(problem.exemplar.pixels.extent(), domain);
}

std::unique_ptr<Model> analyze(const Problem& problem, const Params& params, Seed) {
  require_usable(problem.exemplar);
  if (problem.observed == nullptr) throw std::invalid_argument("inpainting: expected a mask of what is missing");
  try {
    return std::make_unique<Inpainting>(problem.exemplar.pixels, problem.observed->missing, problem.second,
                                        inpainting_options(params));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", problem.exemplar.name, error.what()));
  }
}

}  // namespace

std::optional<std::string> refuse_other_raster(Extent picture, const Domain& domain) {
  if (domain.periodic || domain.size != picture || domain.origin != Point2{} || domain.step != 1) {
    return fmt::format(
        "inpainting draws the missing pixels of a picture: expected a window of its own {}x{} pixels that is not "
        "periodic, from (0, 0) by step 1",
        picture.width, picture.height);
  }
  return std::nullopt;
}

InpaintingOptions inpainting_options(const Params& params) {
  InpaintingOptions options;
  options.border = static_cast<int>(params.integer("border"));
  options.periodic = params.text("covariance") == "torus";
  options.nugget = params.number("nugget");
  options.solve = {.solver = kriging_solver(params.text("solver")),
                   .tolerance = params.number("tolerance"),
                   .iterations = static_cast<int>(params.integer("iterations"))};
  if (!params.text("clean").empty()) options.clean = parse_rectangle(params.text("clean"));
  return options;
}

MethodEntry inpainting_entry() {
  return {.name = "inpainting",
          .title = "Gaussian inpainting by kriging",
          .reference = "Lectures 2022, Inpainting of a Gaussian texture; Galerne and Leclaire 2017",
          .params = inpainting_params(),
          .refuses = refuse,
          .analyze = analyze};
}

}  // namespace textonbench
