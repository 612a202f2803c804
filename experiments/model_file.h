// A fitted spot noise without its exemplar: what `textonbench fit` writes and `synth --model` reads.
//
// JSON: {"format": "textonbench model", "version": 1, "method", "params" {NAME: value}, "exemplar" {"name", "sha256"},
// "seed", "mean" [one number a channel], "support_pixels", "kernels" [{"width", "height", "channels", "values":
// [channel by channel, row by row, top row first]}]}. Where the kernels are the coefficients of B-splines of the plane
// "order" and "support_area" (methods/base/texton.h) are there as well, and for a stack of maps "maps" [{"name",
// "channels"}], in the order of their channels. Numbers are written so that reading gives the
// same float32.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "methods/base/image_maps.h"
#include "methods/base/params.h"
#include "methods/base/texton.h"

namespace textonbench {

struct ModelFile {
  std::string method;
  std::map<std::string, ParamValue> params;  ///< complete
  std::string exemplar, exemplar_sha256;
  std::uint64_t seed = 1;
  Texton texton;                            ///< kernels of a spot noise on Z², or coefficients of B-splines
  std::optional<int> order = std::nullopt;  ///< of the B-splines; nothing for a spot noise
  double support_area = 0;                  ///< of the B-splines, pixels²
  std::vector<ImageMap> maps = {};          ///< of a stack, in the order of their channels

  /// The coefficients as what methods/spot/spline_noise.h draws. `order` is set.
  SplineTexton spline_texton() const { return {texton, order.value(), support_area}; }
};

/// Throws std::invalid_argument with the file, the key and what was expected.
ModelFile read_model_file(const std::filesystem::path& file);

/// Throws std::runtime_error when the file cannot be written.
void write_model_file(const ModelFile& model, const std::filesystem::path& file);

/// A texton in the text format of texton_file.h as a model of one kernel whose support is its rectangle, without the
/// frame of zeros; the method is empty. Order 0 is a spot noise on Z², of the same law there. Throws
/// std::invalid_argument as read_texton_file does, and for a texton that is nothing but frame.
ModelFile read_texton_as_model(const std::filesystem::path& file);

}  // namespace textonbench
