#include "experiments/cli/sample_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "methods/base/image_io.h"

namespace textonbench::cli {

std::vector<std::filesystem::path> write_sample(const Image& sample, std::span<const ImageMap> maps,
                                                const std::filesystem::path& output) {
  if (maps.empty() || output.extension() == ".exr") {
    write_image(sample, output, maps);
    return {output};
  }
  const std::vector<Image> pictures = split_maps(sample, maps);
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    files.push_back(beside(output, "_" + maps[i].name));
    write_image(pictures[i], files.back());
  }
  return files;
}

void require_output(const std::filesystem::path& output) {
  std::string extension = output.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (extension != ".png" && extension != ".exr") {
    throw std::invalid_argument(fmt::format("{}: cannot write \"{}\" files; expected .png or .exr", output.string(),
                                            output.extension().string()));
  }
  const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw std::runtime_error(
        fmt::format("{}: cannot be written ({})", output.string(), std::generic_category().message(errno)));
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(output, ignored)) {
    throw std::runtime_error(fmt::format("{}: cannot be written (is a folder)", output.string()));
  }
}

std::filesystem::path beside(const std::filesystem::path& output, const std::string& suffix) {
  return output.parent_path() / fmt::format("{}{}{}", output.stem().string(), suffix, output.extension().string());
}

}  // namespace textonbench::cli
