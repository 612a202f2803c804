#include "experiments/glsl_export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <variant>

#include "gpu/shader_source.h"
#include "methods/base/image_io.h"

namespace textonbench {
namespace {

constexpr double most_code = 65535;

/// PROCESS of gpu/shaders/impact_grid.glsl.
struct ProcessNumber {
  static constexpr int signed_poisson = 1, stratified = 2, paper = 3;
};

/// What the recipe says, by the names that its shader reads.
class TextonRecipe {
 public:
  explicit TextonRecipe(const ShaderRecipe& recipe) : recipe_(recipe) {
    if (recipe.shader != "texton_noise" || recipe.textures.size() != 1) {
      throw std::invalid_argument(
          fmt::format("export of the shader {}: expected texton_noise, whose kernels are one texture", recipe.shader));
    }
    if (find_define("SHARE") != nullptr) {
      throw std::invalid_argument("export of kernels chosen by place: expected texton_noise, of one texture");
    }
    if (order() != 0 && order() != 1 && order() != 3) {
      throw std::invalid_argument(
          fmt::format("export of splines of order {}: bilinear fetches make orders 0, 1 and 3", order()));
    }
    if (recipe.channels > 3) {
      throw std::invalid_argument(fmt::format(
          "export of {} channels: expected at most 3, those of one texture; export maps one by one", recipe.channels));
    }
    if (process() == ProcessNumber::paper) {
      throw std::invalid_argument(
          "export of the paper's impacts, which repeat: expected impacts=stratified or impacts=poisson");
    }
  }

  int order() const { return define("ORDER"); }
  int process() const { return define("PROCESS"); }
  int kernels() const { return define("KERNELS"); }
  Extent kernel() const { return {define("WIDTH"), define("HEIGHT")}; }
  int channels() const { return recipe_.channels; }
  double side() const { return uniform<std::int32_t>("cell_side") / 1024.0; }
  std::uint64_t key() const {
    const auto words = uniform<std::array<std::uint32_t, 2>>("key");
    return std::uint64_t{words[1]} << 32U | words[0];
  }
  std::vector<float> start() const { return uniform<std::vector<float>>("start"); }
  /// Of a cell's number of impacts, none where there is one.
  std::vector<std::uint32_t> thresholds() const {
    if (process() == ProcessNumber::stratified) return {};
    const std::vector<std::uint32_t>& words = recipe_.words.front().words;
    return {words.begin(), words.begin() + define("THRESHOLDS")};
  }
  /// Impacts a cell: the sum of the probabilities that there are more than n.
  double cell_mean() const {
    if (process() == ProcessNumber::stratified) return 1;
    double mean = 0;
    for (const std::uint32_t threshold : thresholds()) mean += 1 - threshold * 0x1p-32;
    return mean;
  }
  float texel(int kernel, int channel, int x, int y) const {
    const ShaderTexture& texture = recipe_.textures.front();
    const auto row =
        static_cast<std::size_t>(kernel) * static_cast<std::size_t>(texture.size.height) + static_cast<std::size_t>(y);
    const std::size_t place = row * static_cast<std::size_t>(texture.size.width) + static_cast<std::size_t>(x);
    return texture.levels
        .front()[place * static_cast<std::size_t>(texture.components) + static_cast<std::size_t>(channel)];
  }

 private:
  const std::string* find_define(std::string_view name) const {
    const auto found =
        std::ranges::find(recipe_.defines, name, [](const auto& d) -> std::string_view { return d.first; });
    return found == recipe_.defines.end() ? nullptr : &found->second;
  }
  int define(std::string_view name) const { return std::stoi(*find_define(name)); }
  template <class Value>
  Value uniform(std::string_view name) const {
    const auto found =
        std::ranges::find(recipe_.uniforms, name, [](const auto& u) -> std::string_view { return u.first; });
    return std::get<Value>(found->second);
  }

  const ShaderRecipe& recipe_;
};

/// So wide that fetches of a kernel's last coefficients meet no other kernel and no edge of the texture.
int frame_of_order(int order) { return order == 3 ? 3 : 1; }

Image framed_kernels(const TextonRecipe& recipe) {
  const int frame = frame_of_order(recipe.order());
  const auto [width, height] = recipe.kernel();
  Image texels({width + 2 * frame, recipe.kernels() * (height + frame) + frame},
               recipe.channels() == 2 ? 3 : recipe.channels());
  for (int k = 0; k < recipe.kernels(); ++k) {
    for (int c = 0; c < recipe.channels(); ++c) {
      for (int y = 0; y < height; ++y) {
        const auto row = texels.row(c, frame + k * (height + frame) + y);
        for (int x = 0; x < width; ++x)
          row[static_cast<std::size_t>(frame) + static_cast<std::size_t>(x)] = recipe.texel(k, c, x, y);
      }
    }
  }
  return texels;
}

/// Zero is a code of its own, so that frames stay zero.
void encode_texels(GlslExport& made, double intensity, Extent kernel) {
  float low = 0, high = 0;
  for (int c = 0; c < made.texels.channels(); ++c) {
    for (int y = 0; y < made.texels.height(); ++y) {
      for (const float v : made.texels.row(c, y)) low = std::min(low, v), high = std::max(high, v);
    }
  }
  const double step = (static_cast<double>(high) - static_cast<double>(low)) / (most_code - 2);
  const double zero = std::ceil(-static_cast<double>(low) / step);
  made.scale = most_code * step;
  made.offset = -zero * step;
  made.codes = Image(made.texels.extent(), made.texels.channels());
  for (int c = 0; c < made.codes.channels(); ++c) {
    for (int y = 0; y < made.codes.height(); ++y) {
      std::ranges::transform(made.texels.row(c, y), made.codes.row(c, y).begin(), [&](float v) {
        return static_cast<float>((std::round(static_cast<double>(v) / step) + zero) / most_code);
      });
    }
  }
  // Errors of the coefficients are uniform in ± step / 2; splines between them make them no larger.
  made.png_error = step * std::sqrt(intensity * static_cast<double>(kernel.area()) / 12);
}

std::string glsl_vector(const std::vector<float>& values) {
  std::vector<std::string> four(4, "0.0");
  std::ranges::transform(values, four.begin(), [](float v) { return fmt::format("{:#.9g}", v); });
  return fmt::format("vec4({})", fmt::join(four, ", "));
}

std::string constants(const GlslExport& made, const TextonRecipe& recipe) {
  constexpr std::array<std::string_view, 3> types{"float", "vec2", "vec3"}, swizzles{"x", "xy", "xyz"};
  const auto channels = static_cast<std::size_t>(recipe.channels()) - 1;
  const auto [width, height] = recipe.kernel();
  const int frame = frame_of_order(recipe.order());
  std::string text =
      "// Texton noise (Galerne, Leclaire, Moisan, Computer Graphics Forum 2017), exported by textonbench. GLSL "
      "3.30.\n";
  const auto define = [&text](std::string_view name, const auto& value) {
    text += fmt::format("#define TEXTON_NOISE_{} {}\n", name, value);
  };
  define("TYPE", types[channels]);
  define("CHANNELS", swizzles[channels]);
  define("ORDER", recipe.order());
  define("KERNELS", recipe.kernels());
  define("WIDTH", width);
  define("HEIGHT", height);
  define("TEXELS", fmt::format("ivec2({}, {})", made.texels.width(), made.texels.height()));
  define("FRAME", frame);
  define("TILE", height + frame);
  define("STRATIFIED", recipe.process() == ProcessNumber::stratified ? 1 : 0);
  define("SIGNED", recipe.process() == ProcessNumber::signed_poisson ? 1 : 0);
  text += fmt::format("#define TEXTON_NOISE_CELL {:#.12g}  // side of a cell, pixels of the exemplar\n", recipe.side());
  define("START", glsl_vector(recipe.start()));
  text += fmt::format(
      "#ifdef TEXTON_NOISE_FROM_PNG  // define it where the texture is texton.png, not texton.exr\n"
      "#define TEXTON_NOISE_SCALE {:#.9g}\n#define TEXTON_NOISE_OFFSET {:#.9g}\n#else\n"
      "#define TEXTON_NOISE_SCALE 1.0\n#define TEXTON_NOISE_OFFSET 0.0\n#endif\n",
      made.scale, made.offset);
  text += fmt::format("const uvec2 texton_noise_key = uvec2(0x{:08X}u, 0x{:08X}u);\n",
                      static_cast<std::uint32_t>(made.key), static_cast<std::uint32_t>(made.key >> 32U));
  if (recipe.process() != ProcessNumber::stratified) {
    const std::vector<std::uint32_t> thresholds = recipe.thresholds();
    define("MOST", thresholds.size());
    const std::size_t length = std::max<std::size_t>(thresholds.size(), 1);
    text += fmt::format("const uint texton_noise_thresholds[{}] = uint[{}]({}u);\n", length, length,
                        thresholds.empty() ? "0" : fmt::format("{}", fmt::join(thresholds, "u, ")));
  }
  return text;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

}  // namespace

GlslExport make_glsl_export(const ShaderRecipe& shader) {
  const TextonRecipe recipe(shader);
  const Extent kernel = recipe.kernel();
  GlslExport made;
  made.key = recipe.key();
  made.order = recipe.order();
  made.kernels = recipe.kernels();
  made.cell = recipe.side();
  made.texels = framed_kernels(recipe);
  const double intensity = recipe.cell_mean() / (made.cell * made.cell);
  encode_texels(made, intensity, kernel);
  made.fetches_an_impact = made.order == 3 ? 4 : 1;
  const double across = kernel.width + made.order, down = kernel.height + made.order;
  made.fetches = intensity * across * down * made.fetches_an_impact;
  made.cells = (std::floor(across / made.cell) + 2) * (std::floor(down / made.cell) + 2);
  made.function = constants(made, recipe) + "\n" + shader_files().at("export_texton_noise.glsl");
  const int channels = recipe.channels();
  const std::string_view color = channels == 1   ? "vec4(vec3(noise), 1.0)"
                                 : channels == 2 ? "vec4(noise, 0.0, 1.0)"
                                                 : "vec4(noise, 1.0)";
  made.example = fmt::format(
      "#version 330 core\nuniform sampler2D texton;\nout vec4 color;\n\n{}\nvoid main() {{\n"
      "  TEXTON_NOISE_TYPE noise = texton_noise(texton, gl_FragCoord.xy - 0.5);\n  color = {};\n}}\n",
      made.function, color);
  return made;
}

std::string glsl_readme(const GlslExport& made, const GlslOrigin& origin) {
  const double kilobytes = 1e-3 * static_cast<double>(made.texels.extent().area()) * made.texels.channels();
  return fmt::format(
      R"(# Texton noise of {exemplar}

Made by `{command}`. Exemplar: SHA-256 {sha256}, license {licence}; the texton is made from it.

- `texton_noise.glsl`: `texton_noise(texton, position)` is the noise at a place in pixels of the exemplar, by GLSL 3.30 or newer.
  `example.frag` is a whole shader with it, and `preview.png` what it draws at (0, 0) to (255, 255), first row at y = 0.
- Cost: {fetches:.1f} fetches a point in the mean, {each} an impact, in at most {cells:.0f} cells; 1 sampler; {full:.0f} kB as float32, {half:.0f} kB as 16 bits.
- Texture: `texton.exr`, or `texton.png` with `#define TEXTON_NOISE_FROM_PNG` first (its rounding makes an error of {error:.1e} of
  the value's unit). First row at 0, no sRGB decoding, {filter}, clamped to the edge, no mip levels.
- Seed: the key is 0x{key:016X}; any other two words are another noise. Cells of {cell:.6g} pixels repeat after 2^32 of them.
- Beyond 262144 pixels from the origin give `texton_noise(texton, key, cell, offset)` the cell and the place in it.
- Values are those of the exemplar's file, in [0, 1] but for what the noise exceeds; order {order}, {kernels} kernel(s).
)",
      fmt::arg("exemplar", origin.exemplar), fmt::arg("command", origin.command), fmt::arg("sha256", origin.sha256),
      fmt::arg("licence", origin.licence), fmt::arg("fetches", made.fetches), fmt::arg("each", made.fetches_an_impact),
      fmt::arg("cells", made.cells), fmt::arg("full", 4 * kilobytes), fmt::arg("half", 2 * kilobytes),
      fmt::arg("error", made.png_error),
      fmt::arg("filter", made.order == 0 ? "nearest texel" : "linear between texels"), fmt::arg("key", made.key),
      fmt::arg("cell", made.cell), fmt::arg("order", made.order), fmt::arg("kernels", made.kernels));
}

std::vector<std::filesystem::path> write_glsl_export(const GlslExport& made, const Image& preview,
                                                     const std::string& readme, const std::filesystem::path& folder) {
  if (std::filesystem::exists(std::filesystem::symlink_status(folder))) {
    throw std::invalid_argument(fmt::format("{} exists: expected a new folder for the export", folder.string()));
  }
  std::filesystem::path beside = folder;
  if (!beside.has_filename()) beside = beside.parent_path();
  beside += fmt::format(".{}", getpid());
  try {
    if (!std::filesystem::create_directory(beside)) {
      throw std::runtime_error(fmt::format("{}: cannot be made", beside.string()));
    }
    write_text(beside / "texton_noise.glsl", made.function);
    write_text(beside / "example.frag", made.example);
    write_image(made.texels, beside / "texton.exr");
    write_png_16(made.codes, beside / "texton.png");
    write_image(preview, beside / "preview.png");
    write_text(beside / "README.md", readme);
    std::filesystem::rename(beside, folder);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove_all(beside, ignored);
    throw;
  }
  std::vector<std::filesystem::path> files;
  for (const char* name :
       {"README.md", "texton_noise.glsl", "example.frag", "texton.exr", "texton.png", "preview.png"}) {
    files.push_back(folder / name);
  }
  return files;
}

}  // namespace textonbench
