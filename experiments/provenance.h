// Where a number comes from: code, machine, libraries.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace textonbench {

/// Keys: version, git_commit ("unknown" outside a checkout), git_dirty, git_diff (SHA-256 of
/// source_diff(), null without one), compiler, flags, build_type, cpu, simd (the instructions that vectorized kernels
/// are dispatched to: "avx512f", "avx2" or "default"), cores, threads, os, libraries {eigen, fftw, openimageio, tbb,
/// …}, fft_plans.
nlohmann::ordered_json provenance();

/// 16 hexadecimal digits of a source file, a path without extension such as "methods/spectral/rpn": SHA-256, taken at
/// build time, of that file and all of methods/ and experiments/metrics/ that it includes, with what these declare.
/// Known are the files of the method families and of metrics/, experiments/execute and
/// experiments/procedural_exemplars; throws std::invalid_argument for others.
std::string_view source_version(std::string_view path);
/// That of the file below methods/ that has the method's name. Throws std::invalid_argument when there is none.
std::string_view method_version(std::string_view method);

/// What the sources that this program was built from had beyond their commit, as a patch; empty when nothing.
const char* source_diff();

/// Lower-case hexadecimal SHA-256.
std::string sha256(std::string_view bytes);
std::string sha256_of_file(const std::filesystem::path& file);

/// The folder that holds configs/ and templates: TEXTONBENCH_HOME, else the nearest one upward from the program's own
/// place (a build tree), else <prefix>/share/textonbench. Throws std::invalid_argument when there is none.
std::filesystem::path home_folder();

}  // namespace textonbench
