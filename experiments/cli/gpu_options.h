// [--context …] [--path …] [--fetch …] [--filter …] [--window …] [--half] of fps and synth.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/renderer.h"

namespace textonbench::cli {

class GpuOptions {
 public:
  void add_to(CLI::App& app);

  /// Whether one of them stands on the command line.
  bool any_given() const;
  /// Throws GpuError, as the function of this name in gpu/context.h.
  std::unique_ptr<Context> make_context() const;
  /// Compute where the context has it, unless a path was named. Throws std::invalid_argument for "all".
  ShaderPath read_path(const ContextInfo& info) const;
  /// As read_path, or all that the context has.
  std::vector<ShaderPath> read_paths(const ContextInfo& info) const;
  ShaderRequest read_request(Seed seed) const;

 private:
  std::vector<const CLI::Option*> given_;
  std::string context_, path_;
  ShaderFetch fetch_ = ShaderFetch::hardware;
  ShaderFilter filter_ = ShaderFilter::none;
  ShaderWindow window_ = ShaderWindow::footprint;
  bool half_float_ = false;
};

/// "llvmpipe (LLVM 15.0.6, 256 bits) [software]"
std::string renderer_label(const ContextInfo& info);

}  // namespace textonbench::cli
