#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/cli/command.h"
#include "experiments/cli/sample_file.h"
#include "experiments/execute.h"
#include "experiments/inpainting_pictures.h"
#include "experiments/progress.h"
#include "experiments/provenance.h"
#include "methods/base/image_io.h"
#include "methods/base/masks.h"
#include "methods/conditional/inpainting.h"

namespace textonbench::cli {
namespace {

struct InpaintOptions {
  std::string image, mask, other;
  std::vector<std::string> rectangles;
  std::map<std::string, std::string> given;  ///< options of the method, as written
  std::filesystem::path output;
  std::uint64_t seed = 1;
  int samples = 1;
  bool components = false;
  bool json = false;
};

/// Options of the command that are the method's: all but those that name the mask and another exemplar.
bool is_own_option(const ParamSpec& spec) { return spec.name != "mask" && spec.name != "model"; }

/// What --help shows for the value of an option.
std::string kind_of(const ParamSpec& spec) {
  if (!spec.choices.empty()) return fmt::format("{}", fmt::join(spec.choices, "|"));
  if (spec.name == "clean") return "X,Y,W,H";
  return std::holds_alternative<std::int64_t>(spec.default_value) ? "INT" : "NUMBER";
}

Params read_inpainting_params(const InpaintOptions& asked) {
  const MethodEntry entry = inpainting_entry();
  std::map<std::string, ParamValue> values;
  for (const auto& [name, text] : asked.given)
    values.insert(parse_param(entry.params, fmt::format("{}={}", name, text)));
  return {entry.params, values};
}

std::string mask_description(const InpaintOptions& asked) {
  if (asked.mask.empty() == asked.rectangles.empty()) {
    throw std::invalid_argument(
        fmt::format("inpaint: {} --mask and --rect; expected one of the two, for what is missing",
                    asked.mask.empty() ? "neither" : "both"));
  }
  const bool is_shape = !asked.mask.empty() && !mask_file(asked.mask) && !asked.mask.starts_with("rect:");
  if (asked.given.contains("missing") && !is_shape) {
    throw std::invalid_argument(
        "inpaint: --missing with a mask that says itself what is missing; expected --mask with the name of a shape");
  }
  return asked.mask.empty() ? fmt::format("rect:{}", fmt::join(asked.rectangles, ";")) : asked.mask;
}

Exemplar load_named(const std::string& name, bool quiet, const ReadOptions& options) {
  std::vector<std::string> notes;
  Exemplar exemplar = load_exemplar(find_exemplar(ExemplarCatalog(home_folder()), name), &notes, options);
  if (!quiet) {
    for (const std::string& note : notes) fmt::print(stderr, "{}: {}\n", exemplar.name, note);
  }
  return exemplar;
}

std::unique_ptr<const Inpainting> set_up(const InpaintOptions& asked, const Exemplar& picture, const Mask& missing,
                                         const InpaintingOptions& options, bool quiet) {
  std::optional<Exemplar> other;
  if (!asked.other.empty()) other = load_named(asked.other, quiet, {});
  try {
    return std::make_unique<const Inpainting>(picture.pixels, missing, other ? &*other : nullptr, options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", asked.image, error.what()));
  }
}

/// Tells on standard error how far the solution of a system is.
SolveObserver tell_iterations(StatusLine& line, const std::string& what, const SolveOptions& options) {
  return [&line, what, options](int iteration, std::span<const double>, double residual) {
    if (!line.due()) return;
    line.tell(fmt::format("{}: iteration {} of at most {}, residual {:.1e} (tolerance {})", what, iteration,
                          options.iterations, residual, options.tolerance));
  };
}

void warn_if_not_converged(const SolveSummary& summary, const std::string& what, const SolveOptions& options) {
  if (summary.converged()) return;
  const bool preconditioned = summary.solver == KrigingSolver::schwarz;
  fmt::print(stderr,
             "textonbench: warning: {} was not solved to the tolerance of {}: {} stopped after {} iterations at a "
             "residual of {:.1e}, and the picture may break at the borders of what was missing; give it more "
             "--iterations, {}or --nugget 1e-4\n",
             what, options.tolerance, name_of(summary.solver), summary.iterations, summary.residual,
             preconditioned ? "" : "--solver schwarz, ");
}

nlohmann::ordered_json to_json(const SolveSummary& summary) {
  return {{"solver", name_of(summary.solver)},
          {"unknowns", summary.unknowns},
          {"iterations", summary.iterations},
          {"residual", summary.residual},
          {"reason", summary.reason},
          {"converged", summary.converged()},
          {"seconds", {{"setup", summary.setup_seconds}, {"solve", summary.solve_seconds}}},
          {"bytes", summary.bytes}};
}

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  return names;
}

/// What is told of one system: files that it made, and how it was solved.
struct Solved {
  std::vector<std::filesystem::path> files;
  SolveSummary summary;
};

/// STEM_masked, STEM_conditioning, STEM_kriging, STEM_innovation and the strip of these and the sample.
Solved write_components(const InpaintOptions& asked, const Inpainting& model, const Exemplar& picture,
                        const Image& sample, StatusLine& line) {
  Inpainting::Sample kriging = model.kriging_sample(tell_iterations(line, "kriging component", model.options().solve));
  line.erase();
  warn_if_not_converged(kriging.summary, "the kriging component", model.options().solve);
  const std::vector<double>& mean = model.kriging_operator().field().mean;
  std::vector<CaptionedPicture> pictures;
  pictures.push_back({"masked", without_pixels(picture.pixels, model.missing())});
  pictures.push_back({"conditioning points", only_pixels(picture.pixels, model.conditioning())});
  pictures.push_back({"kriging", kriging.image});
  pictures.push_back({"innovation", innovation_picture(sample, kriging.image, model.missing(), mean)});
  Solved result{.files = {}, .summary = kriging.summary};
  for (const CaptionedPicture& entry : pictures) {
    const std::string suffix = fmt::format("_{}", entry.caption.substr(0, entry.caption.find(' ')));
    const std::vector<std::filesystem::path> files =
        write_sample(entry.picture, picture.maps, beside(asked.output, suffix));
    result.files.insert(result.files.end(), files.begin(), files.end());
  }
  pictures.push_back({"result", sample});
  if (!picture.maps.empty()) {
    for (CaptionedPicture& entry : pictures) entry.picture = side_by_side(entry.picture, picture.maps);
  }
  const std::filesystem::path strip = beside(asked.output, "_strip").replace_extension(".png");
  write_image(picture_strip(pictures), strip);
  result.files.push_back(strip);
  return result;
}

void print_summary(const Solved& solved, const Inpainting& model) {
  const SolveSummary& s = solved.summary;
  const Extent size = model.missing().extent();
  fmt::print(
      "{}: {}x{}, {} pixels missing, {} conditioning; {}, {} unknowns, {}residual {:.1e} (set-up {:.2f} s, "
      "solution {:.2f} s)\n",
      fmt::join(names_of(solved.files), " "), size.width, size.height, model.missing().count(),
      model.conditioning().count(), name_of(s.solver), s.unknowns,
      s.solver == KrigingSolver::dense ? "" : fmt::format("{} iterations, ", s.iterations), s.residual, s.setup_seconds,
      s.solve_seconds);
}

nlohmann::ordered_json document_of(const InpaintOptions& asked, const Inpainting& model,
                                   const std::vector<Solved>& samples, const std::optional<Solved>& components,
                                   double seconds) {
  nlohmann::ordered_json drawn = nlohmann::ordered_json::array();
  for (const Solved& sample : samples) {
    nlohmann::ordered_json one = to_json(sample.summary);
    one["files"] = names_of(sample.files);
    drawn.push_back(one);
  }
  const Extent size = model.missing().extent();
  nlohmann::ordered_json document = {{"image", asked.image},
                                     {"output", asked.output.string()},
                                     {"size", {size.width, size.height}},
                                     {"seed", asked.seed},
                                     {"missing_pixels", model.missing().count()},
                                     {"conditioning_pixels", model.conditioning().count()},
                                     {"mean", model.kriging_operator().field().mean},
                                     {"nugget_variance", model.kriging_operator().field().nugget_variance},
                                     {"samples", drawn}};
  if (components) {
    document["kriging"] = to_json(components->summary);
    document["components"] = names_of(components->files);
  }
  document["seconds"] = seconds;
  return document;
}

int inpaint(const InpaintOptions& asked, const GlobalOptions& globals) {
  const tbb::global_control threads = limit_threads(globals);
  const auto start = std::chrono::steady_clock::now();
  const Params params = read_inpainting_params(asked);
  const InpaintingOptions options = inpainting_options(params);
  const std::string description = mask_description(asked);
  require_output(asked.output);
  const Exemplar picture = load_named(asked.image, globals.quiet, {.non_finite = true});
  const Mask missing = make_mask(description, params.number("missing"), picture.pixels.extent());
  StatusLine line(!globals.quiet);
  const std::unique_ptr<const Inpainting> model = set_up(asked, picture, missing, options, globals.quiet);

  std::vector<Solved> samples;
  std::optional<Solved> components;
  samples.reserve(static_cast<std::size_t>(asked.samples));
  for (int i = 0; i < asked.samples; ++i) {
    const std::string what = asked.samples == 1 ? "the sample" : fmt::format("sample {} of {}", i + 1, asked.samples);
    Inpainting::Sample sample = model->sample(sample_seed(asked.seed, i), tell_iterations(line, what, options.solve));
    line.erase();
    warn_if_not_converged(sample.summary, what, options.solve);
    const std::filesystem::path output = i == 0 ? asked.output : beside(asked.output, fmt::format("_{}", i + 1));
    samples.push_back({write_sample(sample.image, picture.maps, output), sample.summary});
    if (!asked.json) print_summary(samples.back(), *model);
    if (i == 0 && asked.components) {
      components = write_components(asked, *model, picture, sample.image, line);
      if (!asked.json) fmt::print("{}\n", fmt::join(names_of(components->files), " "));
    }
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (asked.json) print_json(document_of(asked, *model, samples, components, seconds.count()));
  return 0;
}

}  // namespace

Command inpaint_command(CLI::App& app, const GlobalOptions& globals) {
  const auto options = std::make_shared<InpaintOptions>();
  CLI::App* command = app.add_subcommand(
      "inpaint", "Draw the missing pixels of a texture at random, given the others (Gaussian inpainting by kriging)");
  command
      ->add_option("IMAGE", options->image,
                   "Picture file, exemplar (textonbench list exemplars), or maps joined by +; its missing pixels are "
                   "never read and may hold anything, NaN included")
      ->required();
  command->add_option(
      "--mask", options->mask,
      "What is missing: a picture of the same size, of which a pixel that is not zero in any channel means missing "
      "(alpha counts for nothing, the traces of JPEG do), or a shape: square, holes, ragged, pixels, lines");
  command->add_option("--rect", options->rectangles, "Instead of --mask: a missing rectangle x,y,w,h; may be repeated")
      ->allow_extra_args(false)
      ->type_name("X,Y,W,H");
  for (const ParamSpec& spec : inpainting_entry().params) {
    if (!is_own_option(spec)) continue;
    const std::string name(spec.name);
    const std::string usual = to_string(spec.default_value);
    command
        ->add_option_function<std::string>(
            fmt::format("--{}", name), [options, name](const std::string& text) { options->given[name] = text; },
            usual.empty() ? std::string(spec.help) : fmt::format("{} ({})", spec.help, usual))
        ->type_name(kind_of(spec));
  }
  command->add_option("--exemplar", options->other,
                      "Exemplar or picture that the model is estimated from, instead of the known pixels of IMAGE");
  command->add_option("--seed", options->seed, "Any whole number from 0 to 2^64 - 1")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--samples", options->samples, "How many to draw: OUTPUT, OUTPUT_2, OUTPUT_3, ...")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  command
      ->add_option("-o,--output", options->output,
                   "Picture to write: .png (8 bit, clamped) or .exr (float: known pixels keep their bits); of a stack "
                   "as by synth")
      ->required();
  command->add_flag(
      "--components", options->components,
      "Write also how the first sample came about: OUTPUT_masked, OUTPUT_conditioning, OUTPUT_kriging "
      "(the most likely picture), OUTPUT_innovation (what is random of it, plus the mean), and all beside "
      "each other in OUTPUT_strip.png");
  command->add_flag("--json", options->json, "Print one JSON document");
  set_examples(*command,
               "  textonbench inpaint photo.png --mask scratches.png -o repaired.png\n"
               "  textonbench inpaint mamurk_e_1 --rect 78,78,100,100 --components -o hole.png\n"
               "  textonbench inpaint photo.exr --mask holes.png --clean 0,0,256,256 --samples 3 -o draws.exr\n"
               "  textonbench inpaint HR_Cork --mask ragged --missing 5 --border 5 --seed 7 -o ragged.png");
  return {command, [options, &globals] { return inpaint(*options, globals); }};
}

}  // namespace textonbench::cli
