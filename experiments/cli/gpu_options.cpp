#include "experiments/cli/gpu_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace textonbench::cli {
namespace {

template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& option, Value* value,
                        const std::map<std::string, Value>& names, const std::string& type, const std::string& help) {
  return app.add_option(option, *value, help)
      ->transform(CLI::CheckedTransformer(names).description(""))
      ->type_name(type);
}

}  // namespace

void GpuOptions::add_to(CLI::App& app) {
  const std::map<std::string, ShaderFetch> fetches{{"hardware", ShaderFetch::hardware},
                                                   {"manual", ShaderFetch::manual}};
  const std::map<std::string, ShaderFilter> filters{{"none", ShaderFilter::none},
                                                    {"mipmap", ShaderFilter::mipmap},
                                                    {"trilinear", ShaderFilter::trilinear},
                                                    {"anisotropic", ShaderFilter::anisotropic}};
  const std::map<std::string, ShaderWindow> windows{{"footprint", ShaderWindow::footprint},
                                                    {"kernel", ShaderWindow::kernel}};
  given_ = {
      app.add_option("--context", context_, "Where OpenGL draws (egl, osmesa or glfw, the first that there is)")
          ->check(CLI::IsMember({"egl", "glfw", "osmesa"}))
          ->type_name("egl|glfw|osmesa"),
      app.add_option("--path", path_, "Shaders that draw (compute where OpenGL is 4.3 or newer, else fragment)")
          ->check(CLI::IsMember({"fragment", "compute", "all"}))
          ->type_name("fragment|compute|all"),
      add_choice(app, "--fetch", &fetch_, fetches, "hardware|manual",
                 "Who interpolates between texels: the texture unit, or instructions in float32 (hardware)"),
      add_choice(app, "--filter", &filter_, filters, "none|mipmap|trilinear|anisotropic",
                 "How the texture unit filters kernels by the footprint of a pixel (none)"),
      add_choice(app, "--window", &window_, windows, "footprint|kernel",
                 "Impacts that a filtered pixel visits: all that its kernel reaches, or those that the unfiltered one "
                 "reaches (footprint)"),
      app.add_flag("--half", half_float_, "Texels of 16 bits instead of 32")};
}

bool GpuOptions::any_given() const {
  return std::ranges::any_of(given_, [](const CLI::Option* option) { return option->count() > 0; });
}

std::unique_ptr<Context> GpuOptions::make_context() const {
  return context_.empty() ? textonbench::make_context() : textonbench::make_context(context_kind(context_));
}

ShaderPath GpuOptions::read_path(const ContextInfo& info) const {
  if (path_ == "all") throw std::invalid_argument("--path all: expected one path, fragment or compute");
  return read_paths(info).front();
}

std::vector<ShaderPath> GpuOptions::read_paths(const ContextInfo& info) const {
  if (path_ == "all" && info.compute()) return {ShaderPath::fragment, ShaderPath::compute};
  if (path_ == "compute" || (path_.empty() && info.compute())) return {ShaderPath::compute};
  return {ShaderPath::fragment};
}

ShaderRequest GpuOptions::read_request(Seed seed) const {
  return {.seed = seed, .fetch = fetch_, .filter = filter_, .window = window_, .half_float = half_float_};
}

std::string renderer_label(const ContextInfo& info) {
  return fmt::format("{}{}", info.renderer, info.software ? " [software]" : "");
}

}  // namespace textonbench::cli
