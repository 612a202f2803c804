// Pictures that a command writes.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/image_maps.h"

namespace textonbench::cli {

/// Writes one file, or of a stack that is not written as EXR one file a map: STEM_MAP.png. The files written.
std::vector<std::filesystem::path> write_sample(const Image& sample, std::span<const ImageMap> maps,
                                                const std::filesystem::path& output);

/// Throws std::invalid_argument for a file that is neither .png nor .exr, and std::runtime_error, as write_image would,
/// for one in a folder that is not there or cannot be written: before hours of work.
void require_output(const std::filesystem::path& output);

/// "a/b.png" with the suffix "_2" is "a/b_2.png".
std::filesystem::path beside(const std::filesystem::path& output, const std::string& suffix);

}  // namespace textonbench::cli
