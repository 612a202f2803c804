#include "experiments/provenance.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/version.h>
#include <openssl/evp.h>

#include <Eigen/Core>
#include <array>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>

#include "experiments/build_info.h"
#include "methods/base/fft_plan.h"
#include "methods/base/image_io.h"

namespace textonbench {
namespace {

/// Value after `key` and `separator` on the first line of `file` that starts with `key`, or "unknown".
std::string value_in_file(const char* file, std::string_view key, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t at = line.find(separator);
    if (at == std::string::npos) continue;
    const std::size_t first = line.find_first_not_of(" \t\"", at + 1);
    const std::size_t last = line.find_last_not_of(" \t\"");
    if (first != std::string::npos) return line.substr(first, last - first + 1);
  }
  return "unknown";
}

/// Physical cores: distinct (package, core) pairs; the hardware threads where the system does not tell.
unsigned core_count() {
  std::ifstream in("/proc/cpuinfo");
  std::set<std::string> cores;
  std::string package;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("physical id")) package = line;
    if (line.starts_with("core id")) cores.insert(package + line);
  }
  return cores.empty() ? std::thread::hardware_concurrency() : static_cast<unsigned>(cores.size());
}

/// What the dispatch of target_clones picks among the targets that methods/ is compiled for.
const char* simd_target() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) return "avx512f";
  if (__builtin_cpu_supports("avx2")) return "avx2";
#endif
  return "default";
}

/// What cannot change while the program runs.
nlohmann::ordered_json constant_part() {
  const std::string git_state = build_info::git_state;
  nlohmann::ordered_json dirty = git_state == "dirty";
  if (git_state == "unknown") dirty = "unknown";
  nlohmann::ordered_json diff;
  if (const std::string_view text = source_diff(); !text.empty()) diff = sha256(text);
  return {{"version", build_info::version},
          {"git_commit", build_info::git_commit},
          {"git_dirty", dirty},
          {"git_diff", diff},
          {"compiler", build_info::compiler},
          {"flags", build_info::flags},
          {"build_type", build_info::build_type},
          {"cpu", value_in_file("/proc/cpuinfo", "model name", ':')},
          {"simd", simd_target()},
          {"cores", core_count()},
          {"threads", 0},
          {"os", value_in_file("/etc/os-release", "PRETTY_NAME", '=')},
          {"libraries",
           {{"eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
            {"fftw", fft_library_version()},
            {"openimageio", image_library_version()},
            {"tbb", TBB_runtime_version()},
            {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)}}},
          {"fft_plans", fft_plan_rigor()}};
}

class Sha256 {
 public:
  Sha256() {
    if (!context_ || EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) != 1) fail();
  }
  void update(std::string_view bytes) {
    if (EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) != 1) fail();
  }
  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    if (EVP_DigestFinal_ex(context_.get(), digest.data(), &size) != 1) fail();
    std::string text;
    for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
    return text;
  }

 private:
  [[noreturn]] static void fail() { throw std::runtime_error("OpenSSL cannot compute SHA-256"); }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_{EVP_MD_CTX_new(), &EVP_MD_CTX_free};
};

bool is_home(const std::filesystem::path& folder) {
  return std::filesystem::is_regular_file(folder / "configs/exemplars.toml");
}

}  // namespace

nlohmann::ordered_json provenance() {
  static const nlohmann::ordered_json constant = constant_part();
  nlohmann::ordered_json all = constant;
  all["threads"] = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return all;
}

std::string_view source_version(std::string_view path) {
  for (const build_info::SourceVersion& source : build_info::source_versions) {
    if (source.path == path) return source.version;
  }
  throw std::invalid_argument(fmt::format("{}: no source that decides numbers has this path", path));
}

std::string_view method_version(std::string_view method) {
  const std::string ending = fmt::format("/{}", method);
  for (const build_info::SourceVersion& source : build_info::source_versions) {
    if (source.path.starts_with("methods/") && source.path.ends_with(ending)) return source.version;
  }
  throw std::invalid_argument(fmt::format("{}: no file below methods/ has the name of this method", method));
}

const char* source_diff() { return build_info::source_diff; }

std::string sha256(std::string_view bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.hexadecimal();
}

std::string sha256_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  Sha256 hash;
  std::vector<char> buffer(std::size_t{1} << 16);
  while (in) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash.update({buffer.data(), static_cast<std::size_t>(in.gcount())});
  }
  // A folder opens but cannot be read.
  if (!in.eof()) throw std::invalid_argument(fmt::format("{}: cannot be read", file.string()));
  return hash.hexadecimal();
}

std::filesystem::path home_folder() {
  if (const char* set = std::getenv("TEXTONBENCH_HOME"); set != nullptr && *set != '\0') {
    if (!is_home(set)) {
      throw std::invalid_argument(
          fmt::format("TEXTONBENCH_HOME={}: expected a folder that holds configs/exemplars.toml", set));
    }
    return set;
  }
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  for (std::filesystem::path folder = program.parent_path();; folder = folder.parent_path()) {
    if (is_home(folder)) return folder;
    if (folder == folder.root_path()) break;
  }
  std::filesystem::path installed = program.parent_path().parent_path() / "share/textonbench";
  if (is_home(installed)) return installed;
  throw std::invalid_argument(
      fmt::format("no configs/exemplars.toml in a folder above {} nor in {}: set TEXTONBENCH_HOME to the folder that "
                  "holds it",
                  program.string(), installed.string()));
}

}  // namespace textonbench
