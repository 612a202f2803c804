#include "experiments/model_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "experiments/files.h"
#include "experiments/texton_file.h"
#include "methods/base/bspline.h"

namespace textonbench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* model_format = "textonbench model";
constexpr int model_version = 1;
constexpr int largest_side = 1 << 15;

/// Support of kernels with coefficients on a whole box.
double spline_area(Extent box, int order) { return (box.width + order) * (box.height + order); }

/// A model file, for errors that name it and the key.
class ModelReader {
 public:
  explicit ModelReader(const std::filesystem::path& file) : name_(file.string()) {
    if (!std::filesystem::is_regular_file(file)) {
      throw std::invalid_argument(fmt::format("{}: no such file", name_));
    }
    try {
      json_ = Json::parse(read_file(file));
    } catch (const Json::parse_error& error) {
      throw std::invalid_argument(
          fmt::format("{}: expected a model that textonbench fit wrote: {}", name_, error.what()));
    }
    if (!json_.is_object()) refuse("the file", "a JSON object");
  }

  const Json& json() const { return json_; }

  const Json& at(const Json& object, const char* key) const {
    const auto found = object.is_object() ? object.find(key) : object.end();
    if (!object.is_object() || found == object.end()) {
      throw std::invalid_argument(fmt::format("{}: {}: missing", name_, key));
    }
    return *found;
  }
  std::string text(const Json& object, const char* key) const {
    const Json& value = at(object, key);
    if (!value.is_string()) refuse(key, "a string");
    return value.get<std::string>();
  }
  std::int64_t whole(const Json& object, const char* key, std::int64_t least, std::int64_t most) const {
    const Json& value = at(object, key);
    if (!value.is_number_integer() || value.get<std::int64_t>() < least || value.get<std::int64_t>() > most) {
      refuse(key, fmt::format("a whole number from {} to {}", least, most));
    }
    return value.get<std::int64_t>();
  }
  const Json& list(const Json& object, const char* key) const {
    const Json& value = at(object, key);
    if (!value.is_array() || value.empty()) refuse(key, "a list that is not empty");
    return value;
  }
  double number(const Json& value, const char* key) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) refuse(key, "finite numbers");
    return value.get<double>();
  }
  [[noreturn]] void refuse(const char* key, const std::string& expected) const {
    throw std::invalid_argument(fmt::format("{}: {}: expected {}", name_, key, expected));
  }

 private:
  std::string name_;
  Json json_;
};

ParamValue param_of(const ModelReader& reader, const std::string& name, const Json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number_float()) return value.get<double>();
  if (!value.is_string()) reader.refuse(fmt::format("params.{}", name).c_str(), "true, false, a number or a string");
  return value.get<std::string>();
}

Image read_kernel(const ModelReader& reader, const Json& json) {
  const auto width = static_cast<int>(reader.whole(json, "width", 1, largest_side));
  const auto height = static_cast<int>(reader.whole(json, "height", 1, largest_side));
  const auto channels = static_cast<int>(reader.whole(json, "channels", 1, Image::max_channels));
  const Json& values = reader.list(json, "values");
  if (std::ssize(values) != std::int64_t{width} * height * channels) {
    reader.refuse("values", fmt::format("{} x {} x {} numbers, found {}", width, height, channels, values.size()));
  }
  Image kernel({width, height}, channels);
  auto value = values.begin();
  for (int c = 0; c < channels; ++c) {
    for (int y = 0; y < height; ++y) {
      for (float& pixel : kernel.row(c, y)) pixel = static_cast<float>(reader.number(*value++, "values"));
    }
  }
  return kernel;
}

std::vector<ImageMap> read_maps_of_model(const ModelReader& reader, int channels) {
  std::vector<ImageMap> maps;
  if (!reader.json().contains("maps")) return maps;
  int total = 0;
  for (const Json& json : reader.list(reader.json(), "maps")) {
    const ImageMap& map = maps.emplace_back(ImageMap{
        .name = reader.text(json, "name"), .channels = static_cast<int>(reader.whole(json, "channels", 1, 3))});
    if (map.name.empty() || map.channels == 2) reader.refuse("maps", "named maps of 1 or 3 channels");
    total += map.channels;
  }
  if (total != channels) reader.refuse("maps", fmt::format("maps of {} channels in all", channels));
  return maps;
}

Json kernel_json(const Image& kernel) {
  Json values = Json::array();
  for (int c = 0; c < kernel.channels(); ++c) {
    for (int y = 0; y < kernel.height(); ++y) {
      for (const float pixel : kernel.row(c, y)) values.push_back(pixel);
    }
  }
  return {{"width", kernel.width()},
          {"height", kernel.height()},
          {"channels", kernel.channels()},
          {"values", std::move(values)}};
}

}  // namespace

ModelFile read_model_file(const std::filesystem::path& file) {
  const ModelReader reader(file);
  const Json& json = reader.json();
  if (reader.text(json, "format") != model_format) reader.refuse("format", fmt::format("\"{}\"", model_format));
  reader.whole(json, "version", model_version, model_version);
  ModelFile model;
  model.method = reader.text(json, "method");
  const Json& params = reader.at(json, "params");
  if (!params.is_object()) reader.refuse("params", "a JSON object");
  for (const auto& [name, value] : params.items()) model.params.emplace(name, param_of(reader, name, value));
  const Json& exemplar = reader.at(json, "exemplar");
  model.exemplar = reader.text(exemplar, "name");
  model.exemplar_sha256 = reader.text(exemplar, "sha256");
  const Json& seed = reader.at(json, "seed");
  if (!seed.is_number_unsigned()) reader.refuse("seed", "a whole number that is not negative");
  model.seed = seed.get<std::uint64_t>();
  for (const Json& value : reader.list(json, "mean")) model.texton.mean.push_back(reader.number(value, "mean"));
  for (const Json& kernel : reader.list(json, "kernels")) {
    model.texton.kernels.push_back(read_kernel(reader, kernel));
    if (model.texton.kernels.back().extent() != model.texton.extent() ||
        model.texton.kernels.back().channels() != model.texton.channels()) {
      reader.refuse("kernels", "kernels of one size");
    }
  }
  if (std::ssize(model.texton.mean) != model.texton.channels()) {
    reader.refuse("mean", fmt::format("{} numbers, one a channel", model.texton.channels()));
  }
  model.maps = read_maps_of_model(reader, model.texton.channels());
  model.texton.support_pixels = reader.whole(json, "support_pixels", 1, model.texton.extent().area());
  if (json.contains("order")) {
    model.order = static_cast<int>(reader.whole(json, "order", 0, max_bspline_order));
    model.support_area = reader.number(reader.at(json, "support_area"), "support_area");
    const double box = spline_area(model.texton.extent(), *model.order);
    if (!(model.support_area > 0 && model.support_area <= box)) {
      reader.refuse("support_area", fmt::format("a number above 0, at most {}", box));
    }
  }
  return model;
}

void write_model_file(const ModelFile& model, const std::filesystem::path& file) {
  Json params = Json::object();
  for (const auto& [name, value] : model.params) {
    std::visit([&params, key = name](const auto& v) { params[key] = v; }, value);
  }
  Json kernels = Json::array();
  for (const Image& kernel : model.texton.kernels) kernels.push_back(kernel_json(kernel));
  Json json = {{"format", model_format},
               {"version", model_version},
               {"method", model.method},
               {"params", std::move(params)},
               {"exemplar", {{"name", model.exemplar}, {"sha256", model.exemplar_sha256}}},
               {"seed", model.seed},
               {"mean", model.texton.mean},
               {"support_pixels", model.texton.support_pixels},
               {"kernels", std::move(kernels)}};
  for (const ImageMap& map : model.maps) {
    json["maps"].push_back({{"name", map.name}, {"channels", map.channels}});
  }
  if (model.order) {
    json["order"] = *model.order;
    json["support_area"] = model.support_area;
  }
  write_atomically(file, json.dump() + "\n");
}

ModelFile read_texton_as_model(const std::filesystem::path& file) {
  TextonFile texton = read_texton_file(file);
  const int frame = (texton.order + 1) / 2;
  const Extent inner{texton.coefficients.width() - 2 * frame, texton.coefficients.height() - 2 * frame};
  if (inner.width < 1 || inner.height < 1) {
    throw std::invalid_argument(fmt::format("{}: {}x{} coefficients of order {} are nothing but the frame of {} zeros",
                                            file.string(), texton.coefficients.width(), texton.coefficients.height(),
                                            texton.order, frame));
  }
  ModelFile model;
  model.exemplar = texton.source;
  model.texton.mean.assign(texton.mean.begin(), texton.mean.end());
  model.texton.support_pixels = inner.area();
  model.texton.kernels.push_back(crop(texton.coefficients, frame, frame, inner));
  if (texton.order > 0) {
    model.order = texton.order;
    model.support_area = spline_area(inner, texton.order);
  }
  return model;
}

}  // namespace textonbench
