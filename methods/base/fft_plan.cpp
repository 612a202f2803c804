#include "methods/base/fft_plan.h"

#include <fftw3.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>

#include "methods/base/aligned_buffer.h"
#include "methods/base/block_fft.h"

namespace textonbench {
namespace {

bool measured_plans() {
  const char* value = std::getenv("TEXTONBENCH_FFT_PLAN");
  if (value == nullptr || std::string_view(value) == "estimate") {
    return false;
  }
  if (std::string_view(value) == "measure") {
    return true;
  }
  throw std::invalid_argument(fmt::format("TEXTONBENCH_FFT_PLAN=\"{}\": expected \"estimate\" or \"measure\"", value));
}

std::filesystem::path wisdom_file() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  std::filesystem::path folder = cache != nullptr && *cache != '\0' ? std::filesystem::path(cache)
                                 : home != nullptr                  ? std::filesystem::path(home) / ".cache"
                                                                    : std::filesystem::temp_directory_path();
  return folder / "textonbench" / "fftwf-wisdom";
}

/// Written beside and renamed, so that processes planning at once never read half a file.
void save_wisdom() {
  const std::filesystem::path file = wisdom_file();
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  const std::filesystem::path beside = file.string() + "." + std::to_string(getpid());
  if (fftwf_export_wisdom_to_filename(beside.c_str()) != 0) {
    std::filesystem::rename(beside, file, ignored);
  }
}

enum class Layout { line, block };

/// Where a plan of a block finds the real and the imaginary parts. FFTW knows the forward transform only of data whose
/// parts lie apart: the other one swaps them.
struct BlockParts {
  BlockParts(float* block, FftDirection direction)
      : re(direction == FftDirection::forward ? block : block + block_lines),
        im(direction == FftDirection::forward ? block + block_lines : block) {}
  float *re, *im;
};

/// Complex plans, made once. FFTW's planner is not safe between threads; executing a plan is.
class PlanCache {
 public:
  fftwf_plan get(Layout layout, int length, FftDirection direction) {
    const std::lock_guard lock(mutex_);
    fftwf_plan& plan = plans_[{layout, length, direction}];
    if (plan == nullptr) {
      plan = make(layout, length, direction);
    }
    return plan;
  }

 private:
  static fftwf_plan make(Layout layout, int length, FftDirection direction) {
    const bool measure = measured_plans();
    if (measure) {
      fftwf_import_wisdom_from_filename(wisdom_file().c_str());
    }
    const unsigned rigor = measure ? FFTW_MEASURE : FFTW_ESTIMATE;
    // Planning with timing overwrites its arrays, so it gets its own; plans are then executed on any array of the same
    // alignment.
    const AlignedBuffer<float> own(static_cast<std::size_t>(length) * block_row);
    fftwf_plan plan = nullptr;
    if (layout == Layout::line) {
      auto* line = reinterpret_cast<fftwf_complex*>(own.data());
      plan = fftwf_plan_dft_1d(length, line, line, direction == FftDirection::forward ? FFTW_FORWARD : FFTW_BACKWARD,
                               rigor);
    } else {
      const BlockParts parts(own.data(), direction);
      const fftwf_iodim along{length, block_row, block_row};
      const fftwf_iodim across{block_lines, 1, 1};
      plan = fftwf_plan_guru_split_dft(1, &along, 1, &across, parts.re, parts.im, parts.re, parts.im, rigor);
    }
    if (plan == nullptr) {
      throw std::runtime_error(fmt::format("FFTW cannot plan a transform of length {}", length));
    }
    if (measure) {
      save_wisdom();
    }
    return plan;
  }

  std::mutex mutex_;
  std::map<std::tuple<Layout, int, FftDirection>, fftwf_plan> plans_;
};

PlanCache& plan_cache() {
  static PlanCache& cache = *new PlanCache;  // never destroyed: threads may outlive static destruction
  return cache;
}

}  // namespace

LineFft::LineFft(int length, FftDirection direction) : plan_(plan_cache().get(Layout::line, length, direction)) {}

void LineFft::operator()(std::complex<float>* line) const {
  auto* bins = reinterpret_cast<fftwf_complex*>(line);
  fftwf_execute_dft(plan_, bins, bins);
}

AwkwardBlockFft::AwkwardBlockFft(int length, FftDirection direction)
    : plan_(plan_cache().get(Layout::block, length, direction)), direction_(direction) {}

void AwkwardBlockFft::operator()(float* block) const {
  const BlockParts parts(block, direction_);
  fftwf_execute_split_dft(plan_, parts.re, parts.im, parts.re, parts.im);
}

const char* fft_plan_rigor() { return measured_plans() ? "measure" : "estimate"; }

const char* fft_library_version() { return fftwf_version; }

}  // namespace textonbench
