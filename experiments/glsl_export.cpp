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

#include "gpu/shader_source.h"
#include "methods/base/image_io.h"
#include "methods/spot/spline_scale.h"

namespace textonbench {
namespace {

constexpr double most_code = 65535;

void require_exportable(const SplineTexton& texton, const SplineNoiseOptions& options) {
  const int order = texton.order, channels = texton.coefficients.channels();
  if (order != 0 && order != 1 && order != 3) {
    throw std::invalid_argument(
        fmt::format("export of splines of order {}: bilinear fetches make orders 0, 1 and 3", order));
  }
  if (channels > 3) {
    throw std::invalid_argument(fmt::format(
        "export of {} channels: expected at most 3, those of one texture; export maps one by one", channels));
  }
  if (options.impacts == ImpactProcess::paper) {
    throw std::invalid_argument(
        "export of the paper's impacts, which repeat: expected impacts=stratified or impacts=poisson");
  }
  if (options.share) {
    throw std::invalid_argument("export of kernels chosen by place: expected texton_noise, of one texture");
  }
}

/// So wide that fetches of a kernel's last coefficients meet no other kernel and no edge of the texture.
int frame_of_order(int order) { return order == 3 ? 3 : 1; }

Image framed_kernels(const SplineTexton& texton, double scale) {
  const Texton& coefficients = texton.coefficients;
  const int frame = frame_of_order(texton.order), count = static_cast<int>(coefficients.kernels.size());
  const auto [width, height] = coefficients.extent();
  const int channels = coefficients.channels() == 2 ? 3 : coefficients.channels();
  Image texels({width + 2 * frame, count * (height + frame) + frame}, channels);
  for (int k = 0; k < count; ++k) {
    const Image& kernel = coefficients.kernels[static_cast<std::size_t>(k)];
    for (int c = 0; c < kernel.channels(); ++c) {
      for (int y = 0; y < height; ++y) {
        std::ranges::transform(kernel.row(c, y), texels.row(c, frame + k * (height + frame) + y).begin() + frame,
                               [scale](float v) { return static_cast<float>(scale * v); });
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

std::string constants(const GlslExport& made, const SplineTexton& texton, const ImpactGrid& grid,
                      const std::vector<float>& start) {
  constexpr std::array<std::string_view, 3> types{"float", "vec2", "vec3"}, swizzles{"x", "xy", "xyz"};
  const auto channels = static_cast<std::size_t>(texton.coefficients.channels()) - 1;
  const auto [width, height] = texton.coefficients.extent();
  const int frame = frame_of_order(texton.order);
  const bool stratified = grid.process() == ImpactProcess::stratified;
  std::string text =
      "// Texton noise (Galerne, Leclaire, Moisan, Computer Graphics Forum 2017), exported by textonbench. GLSL "
      "3.30.\n";
  const auto define = [&text](std::string_view name, const auto& value) {
    text += fmt::format("#define TEXTON_NOISE_{} {}\n", name, value);
  };
  define("TYPE", types[channels]);
  define("CHANNELS", swizzles[channels]);
  define("ORDER", texton.order);
  define("KERNELS", texton.coefficients.kernels.size());
  define("WIDTH", width);
  define("HEIGHT", height);
  define("TEXELS", fmt::format("ivec2({}, {})", made.texels.width(), made.texels.height()));
  define("FRAME", frame);
  define("TILE", height + frame);
  define("STRATIFIED", stratified ? 1 : 0);
  define("SIGNED", grid.process() == ImpactProcess::signed_poisson ? 1 : 0);
  text += fmt::format("#define TEXTON_NOISE_CELL {:#.12g}  // side of a cell, pixels of the exemplar\n", grid.side());
  define("START", glsl_vector(start));
  text += fmt::format(
      "#ifdef TEXTON_NOISE_FROM_PNG  // define it where the texture is texton.png, not texton.exr\n"
      "#define TEXTON_NOISE_SCALE {:#.9g}\n#define TEXTON_NOISE_OFFSET {:#.9g}\n#else\n"
      "#define TEXTON_NOISE_SCALE 1.0\n#define TEXTON_NOISE_OFFSET 0.0\n#endif\n",
      made.scale, made.offset);
  text += fmt::format("const uvec2 texton_noise_key = uvec2(0x{:08X}u, 0x{:08X}u);\n",
                      static_cast<std::uint32_t>(made.key), static_cast<std::uint32_t>(made.key >> 32U));
  if (!stratified) {
    const std::vector<std::uint32_t>& thresholds = grid.thresholds();
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

GlslExport make_glsl_export(const SplineTexton& texton, const SplineNoiseOptions& options, Seed seed) {
  require_exportable(texton, options);
  const ImpactGrid grid = spline_noise_impacts(texton, options);
  const double scale = spline_noise_scale(texton, options, grid);
  const Extent kernel = texton.coefficients.extent();
  GlslExport made;
  made.key = spline_noise_key(seed);
  made.texels = framed_kernels(texton, scale);
  encode_texels(made, grid.intensity(), kernel);
  made.fetches_an_impact = texton.order == 3 ? 4 : 1;
  const double across = kernel.width + texton.order, down = kernel.height + texton.order;
  made.fetches = grid.intensity() * across * down * made.fetches_an_impact;
  made.cell = grid.side();
  made.cells = (std::floor(across / grid.side()) + 2) * (std::floor(down / grid.side()) + 2);
  made.function = constants(made, texton, grid, spline_noise_start(texton, scale, grid)) + "\n" +
                  shader_files().at("export_texton_noise.glsl");
  const int channels = texton.coefficients.channels();
  const std::string_view color = channels == 1   ? "vec4(vec3(noise), 1.0)"
                                 : channels == 2 ? "vec4(noise, 0.0, 1.0)"
                                                 : "vec4(noise, 1.0)";
  made.example = fmt::format(
      "#version 330 core\nuniform sampler2D texton;\nout vec4 color;\n\n{}\nvoid main() {{\n"
      "  TEXTON_NOISE_TYPE noise = texton_noise(texton, gl_FragCoord.xy - 0.5);\n  color = {};\n}}\n",
      made.function, color);
  return made;
}

std::string glsl_readme(const GlslExport& made, const SplineTexton& texton, const GlslOrigin& origin) {
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
      fmt::arg("filter", texton.order == 0 ? "nearest texel" : "linear between texels"), fmt::arg("key", made.key),
      fmt::arg("cell", made.cell), fmt::arg("order", texton.order),
      fmt::arg("kernels", texton.coefficients.kernels.size()));
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
