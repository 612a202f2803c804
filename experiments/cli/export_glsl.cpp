#include "experiments/cli/export_glsl.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "experiments/cli/command.h"
#include "experiments/cli/fitted.h"
#include "experiments/execute.h"
#include "experiments/glsl_export.h"
#include "experiments/provenance.h"
#include "experiments/shader_models.h"

namespace textonbench::cli {
namespace {

struct GlslArguments {
  ModelOptions model;
  std::filesystem::path output;
  bool json = false;
};

std::string command_of(const ModelOptions& model) {
  std::string command = fmt::format("textonbench export glsl {} {}", model.method, model.exemplar);
  for (const std::string& param : model.params) command += fmt::format(" -p {}", param);
  return command + fmt::format(" --seed {}", model.seed);
}

/// Two channels are shown as red and green.
Image as_picture(const Image& sample) {
  if (sample.channels() != 2) return sample;
  Image picture(sample.extent(), 3);
  for (int c = 0; c < 2; ++c) {
    for (int y = 0; y < sample.height(); ++y) std::ranges::copy(sample.row(c, y), picture.row(c, y).begin());
  }
  return picture;
}

int export_glsl(const GlslArguments& arguments, const GlobalOptions& globals) {
  const tbb::global_control threads = limit_threads(globals);
  if (std::filesystem::exists(std::filesystem::symlink_status(arguments.output))) {
    throw std::invalid_argument(
        fmt::format("{} exists: expected a new folder for the export", arguments.output.string()));
  }
  ModelOptions asked = arguments.model;
  asked.size = "256x256";  // of the preview
  const Fitted fitted = fit_to_exemplar(asked, globals.quiet);
  const Seed seed = sample_seed(asked.seed, 0);
  const GlslExport made = make_glsl_export(
      shader_of(*fitted.model, asked.method, {.seed = seed, .near = {0, 0}, .fetch = ShaderFetch::manual}));
  const Image sample = fitted.model->synthesize({.size = {256, 256}}, seed);
  const ExemplarInfo info = find_exemplar(ExemplarCatalog(home_folder()), asked.exemplar);
  const GlslOrigin origin{.exemplar = info.name,
                          .sha256 = exemplar_sha256(info),
                          .licence = info.licence.empty() ? "not stated" : info.licence,
                          .command = command_of(asked)};
  const std::string readme = glsl_readme(made, origin);
  const auto files = write_glsl_export(made, as_picture(sample), readme, arguments.output);
  if (arguments.json) {
    nlohmann::ordered_json document = {{"output", arguments.output.string()},
                                       {"fetches_per_pixel", made.fetches},
                                       {"samplers", 1},
                                       {"texels", {made.texels.width(), made.texels.height()}},
                                       {"cell", made.cell},
                                       {"seed", asked.seed},
                                       {"key", fmt::format("0x{:016X}", made.key)},
                                       {"png_error", made.png_error}};
    for (const auto& file : files) document["files"].push_back(file.string());
    print_json(document);
    return 0;
  }
  for (const auto& file : files) fmt::print("{}\n", file.string());
  return 0;
}

}  // namespace

Command export_glsl_command(CLI::App& parent, const GlobalOptions& globals) {
  const auto arguments = std::make_shared<GlslArguments>();
  CLI::App* command =
      parent.add_subcommand("glsl", "Write a noise as a function of GLSL 3.30 with its texture, for other engines");
  arguments->model.add_method_to(*command);
  arguments->model.add_params_to(*command);
  command->add_option("-o,--output", arguments->output, "New folder for the function, its texture and a README")
      ->required();
  command->add_flag("--json", arguments->json, "Print one JSON document");
  set_examples(*command,
               "  textonbench export glsl texton_noise HR_Cork -o cork\n"
               "  textonbench export glsl texton_noise mamurk_e_1 -p order=3 -p support=15 --seed 7 -o paper");
  return {command, [arguments, &globals] { return export_glsl(*arguments, globals); }};
}

}  // namespace textonbench::cli
