#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "experiments/cli/command.h"
#include "experiments/execute.h"
#include "experiments/files.h"
#include "experiments/metrics/metric.h"
#include "experiments/model_file.h"
#include "experiments/provenance.h"
#include "experiments/texton_file.h"
#include "methods/base/image_io.h"

namespace textonbench::cli {
namespace {

struct FitOptions {
  ModelOptions model;
  std::filesystem::path output;
  std::filesystem::path history;
  bool json = false;
};

/// Gray textons are stored with three equal channels.
Image as_color(const Image& kernel) {
  if (kernel.channels() == 3) return kernel;
  Image color(kernel.extent(), 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < kernel.height(); ++y) std::ranges::copy(kernel.row(0, y), color.row(c, y).begin());
  }
  return color;
}

/// The image with `frame` zeros on every side.
Image framed(const Image& image, int frame) {
  Image result({image.width() + 2 * frame, image.height() + 2 * frame}, image.channels());
  for (int c = 0; c < image.channels(); ++c) {
    for (int y = 0; y < image.height(); ++y) {
      std::ranges::copy(image.row(c, y), result.row(c, y + frame).begin() + frame);
    }
  }
  return result;
}

/// Coefficients of one gray or color map in the text format.
TextonFile text_of(const Image& kernel, std::span<const double> mean, int order, const std::string& source) {
  TextonFile texton{.order = order, .coefficients = framed(as_color(kernel), (order + 1) / 2), .source = source};
  for (std::size_t c = 0; c < 3; ++c) texton.mean.at(c) = mean[mean.size() == 1 ? 0 : c];
  return texton;
}

/// STEM.json, and STEM.texton and STEM.exr, or STEM_1.texton … where impacts choose among several kernels. A stack has
/// one .texton a map, STEM_MAP.texton: with the same impacts they give maps that belong together.
std::vector<std::filesystem::path> write_model(const ModelFile& model, const std::filesystem::path& stem,
                                               const std::string& source) {
  std::vector<std::filesystem::path> files{with_suffix(stem, ".json")};
  write_model_file(model, files.front());
  const std::vector<Image>& kernels = model.texton.kernels;
  // An impact adds sqrt(K) h_k. The other formats have no place for the factor, so they hold kernels as they are
  // summed.
  const auto scale = static_cast<float>(std::sqrt(static_cast<double>(kernels.size())));
  const int order = model.order.value_or(0);
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    const std::string number = kernels.size() == 1 ? "" : fmt::format("_{}", k + 1);
    Image kernel = kernels[k];
    for (int c = 0; c < kernel.channels(); ++c) {
      for (int y = 0; y < kernel.height(); ++y) {
        for (float& v : kernel.row(c, y)) v *= scale;
      }
    }
    files.push_back(with_suffix(stem, number + ".exr"));
    write_image(model.maps.empty() ? as_color(kernel) : kernel, files.back(), model.maps);
    if (model.maps.empty()) {
      files.push_back(with_suffix(stem, number + ".texton"));
      write_texton_file(text_of(kernel, model.texton.mean, order, source), files.back());
      continue;
    }
    const std::vector<Image> pictures = split_maps(kernel, model.maps);
    std::span<const double> mean = model.texton.mean;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      files.push_back(with_suffix(stem, fmt::format("{}_{}.texton", number, model.maps[i].name)));
      const auto channels = static_cast<std::size_t>(model.maps[i].channels);
      write_texton_file(text_of(pictures[i], mean.first(channels), order, source), files.back());
      mean = mean.subspan(channels);
    }
  }
  return files;
}

/// The fit's history: a header, and one line a step, numbered from 1.
void write_history(const Convergence& convergence, const std::filesystem::path& file) {
  std::string csv = fmt::format("{},rme\n", convergence.step);
  for (std::size_t i = 0; i < convergence.rme.size(); ++i) csv += fmt::format("{},{}\n", i + 1, convergence.rme[i]);
  write_atomically(file, csv);
}

nlohmann::ordered_json to_json(const Convergence* convergence) {
  if (convergence == nullptr) return nullptr;
  return {{"step", convergence->step},
          {"steps", convergence->rme.size()},
          {"rme", convergence->rme.back()},
          {"reason", convergence->reason}};
}

/// The last steps, and why there was no other.
void tell(const Convergence& convergence) {
  const std::size_t count = convergence.rme.size();
  for (std::size_t i = count - std::min<std::size_t>(3, count); i < count; ++i) {
    fmt::print(stderr, "RME after {} {}: {:.6f}\n", convergence.step, i + 1, convergence.rme[i]);
  }
  fmt::print(stderr, "stopped by: {}\n", convergence.reason);
}

int fit(const FitOptions& options, const GlobalOptions& globals) {
  const tbb::global_control threads = limit_threads(globals);
  const ModelOptions& asked = options.model;
  const MethodEntry& method = find_method(asked.method);
  const Params params = asked.read_params(method);
  const ExemplarCatalog catalog(home_folder());
  const Exemplar exemplar = load_exemplar(find_exemplar(catalog, asked.exemplar));
  require_usable(exemplar);
  const std::unique_ptr<Model> model = method.analyze({exemplar}, params, analysis_seed(asked.seed));
  const SplineTexton* spline = model->spline_texton();
  const Texton* texton = spline != nullptr ? &spline->coefficients : model->texton();
  if (texton == nullptr) {
    throw std::invalid_argument(fmt::format(
        "{} has no texton to write: expected a spot noise or texton noise (textonbench list methods)", asked.method));
  }
  const Convergence* convergence = model->convergence();
  if (!options.history.empty() && convergence == nullptr) {
    throw std::invalid_argument(
        fmt::format("--history: {} fits without iterations; expected sot or optimal_texton", asked.method));
  }
  const Extent size = exemplar.pixels.extent();
  const std::vector<std::filesystem::path> files =
      write_model({.method = asked.method,
                   .params = params.values(),
                   .exemplar = exemplar.name,
                   .exemplar_sha256 = exemplar.sha256,
                   .seed = asked.seed,
                   .texton = *texton,
                   .order = spline != nullptr ? std::optional(spline->order) : std::nullopt,
                   .support_area = spline != nullptr ? spline->support_area : 0,
                   .maps = exemplar.maps},
                  options.output, fmt::format("{} {}x{}", exemplar.name, size.width, size.height));
  if (!options.history.empty()) write_history(*convergence, options.history);

  const std::optional<double> error =
      find_metric("rme").of_model(*model, make_target(exemplar), Domain{.size = size, .periodic = true});
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  if (options.json) {
    print_json({{"files", names},
                {"kernels", texton->kernels.size()},
                {"size", {texton->extent().width, texton->extent().height}},
                {"support_pixels", texton->support_pixels},
                {"rme", error ? nlohmann::ordered_json(*error) : nullptr},
                {"convergence", to_json(convergence)},
                {"seed", asked.seed}});
    return 0;
  }
  fmt::print("{}: {} kernel{} of {}x{}, {} pixels of support{}\n", fmt::join(names, " "), texton->kernels.size(),
             texton->kernels.size() == 1 ? "" : "s", texton->extent().width, texton->extent().height,
             texton->support_pixels, error ? fmt::format(", RME {:.4f}", *error) : "");
  if (!globals.quiet) {
    if (convergence != nullptr) tell(*convergence);
    fmt::print(stderr, "next: textonbench synth --model {} -o sample.png\n", files.front().string());
  }
  return 0;
}

}  // namespace

Command fit_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<FitOptions>();
  CLI::App* fit_app = app.add_subcommand("fit", "Fit a texton to an exemplar and write it to files");
  options->model.add_method_to(*fit_app);
  options->model.add_params_to(*fit_app);
  fit_app
      ->add_option("-o,--output", options->output,
                   "Files to write, without extension: .json (read by synth --model), and each kernel as .texton (the "
                   "text format of the authors of Texton Noise, of a stack one a map) and .exr")
      ->required();
  fit_app->add_option("--history", options->history,
                      "CSV file for the relative model error (RME) after each iteration of sot or evaluation of "
                      "optimal_texton, before any correction of colors");
  fit_app->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*fit_app,
               "  textonbench fit sot mamurk_e_1 -p support=31 -o texton\n"
               "  textonbench fit sot mamurk_e_1 -p iterations=1000 -p tolerance=1e-4 --history history.csv -o texton\n"
               "  textonbench fit texton_noise albedo.png+height.png -o material\n"
               "  textonbench synth --model texton.json --size 1024x1024 -o sample.png");
  return {fit_app, [options, &globals] { return fit(*options, globals); }};
}

}  // namespace textonbench::cli
