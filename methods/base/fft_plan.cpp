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

enum class Layout { line, copied_line, block };

/// Complex plans, made once. FFTW's planner is not safe between threads; executing a plan is.
class PlanCache {
 public:
  fftwf_plan get(Layout layout, int length, FftDirection direction) {
    const std::lock_guard lock(mutex_);
    fftwf_plan& plan = plans_[{layout, length, direction}];
    if (plan == nullptr) {
      plan = make(layout, length, direction == FftDirection::forward ? FFTW_FORWARD : FFTW_BACKWARD);
    }
    return plan;
  }

 private:
  static fftwf_plan make(Layout layout, int length, int sign) {
    const bool measure = measured_plans();
    if (measure) {
      fftwf_import_wisdom_from_filename(wisdom_file().c_str());
    }
    // Planning with timing overwrites its arrays, so it gets its own; plans are then executed on any array of the same
    // alignment.
    const int lines = layout == Layout::block ? 8 : 1;
    const AlignedBuffer<std::complex<float>> from(static_cast<std::size_t>(length) * static_cast<std::size_t>(lines));
    const AlignedBuffer<std::complex<float>> to(layout == Layout::copied_line ? from.size() : 0);
    auto* in = reinterpret_cast<fftwf_complex*>(from.data());
    auto* out = layout == Layout::copied_line ? reinterpret_cast<fftwf_complex*>(to.data()) : in;
    fftwf_plan plan = fftwf_plan_many_dft(1, &length, lines, in, nullptr, lines, 1, out, nullptr, lines, 1, sign,
                                          measure ? FFTW_MEASURE : FFTW_ESTIMATE);
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

void execute(fftwf_plan plan, std::complex<float>* from, std::complex<float>* to) {
  fftwf_execute_dft(plan, reinterpret_cast<fftwf_complex*>(from), reinterpret_cast<fftwf_complex*>(to));
}

}  // namespace

LineFft::LineFft(int length, FftDirection direction) : plan_(plan_cache().get(Layout::line, length, direction)) {}

void LineFft::operator()(std::complex<float>* line) const { execute(plan_, line, line); }

CopyingLineFft::CopyingLineFft(int length, FftDirection direction)
    : plan_(plan_cache().get(Layout::copied_line, length, direction)) {}

void CopyingLineFft::operator()(std::complex<float>* from, std::complex<float>* to) const { execute(plan_, from, to); }

BlockFft::BlockFft(int length, FftDirection direction) : plan_(plan_cache().get(Layout::block, length, direction)) {}

void BlockFft::operator()(std::complex<float>* block) const { execute(plan_, block, block); }

const char* fft_plan_rigor() { return measured_plans() ? "measure" : "estimate"; }

const char* fft_library_version() { return fftwf_version; }

}  // namespace textonbench
