// A fitted spot noise without its exemplar: what `textonbench fit` writes and `synth --model` reads.
//
// JSON: {"format": "textonbench model", "version": 1, "method", "params" {NAME: value}, "exemplar" {"name", "sha256"},
// "seed", "mean" [one number a channel], "support_pixels", "kernels" [{"width", "height", "channels", "values":
// [channel by channel, row by row, top row first]}]}. Numbers are written so that reading gives the same float32.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "methods/base/params.h"
#include "methods/base/texton.h"

namespace textonbench {

struct ModelFile {
  std::string method;
  std::map<std::string, ParamValue> params;  ///< complete
  std::string exemplar, exemplar_sha256;
  std::uint64_t seed = 1;
  Texton texton;
};

/// Throws std::invalid_argument with the file, the key and what was expected.
ModelFile read_model_file(const std::filesystem::path& file);

/// Throws std::runtime_error when the file cannot be written.
void write_model_file(const ModelFile& model, const std::filesystem::path& file);

/// A texton in the text format of texton_file.h as a model of one kernel whose support is its rectangle; the method is
/// empty. Throws std::invalid_argument for an order above 0, whose impacts do not fall on pixels.
ModelFile read_texton_as_model(const std::filesystem::path& file);

}  // namespace textonbench
