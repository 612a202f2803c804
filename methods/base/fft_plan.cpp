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
#include <utility>

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

std::filesystem::path wisdom_file(std::string_view name) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  std::filesystem::path folder = cache != nullptr && *cache != '\0' ? std::filesystem::path(cache)
                                 : home != nullptr                  ? std::filesystem::path(home) / ".cache"
                                                                    : std::filesystem::temp_directory_path();
  return folder / "textonbench" / name;
}

constexpr std::string_view single_wisdom = "fftwf-wisdom";
constexpr std::string_view double_wisdom = "fftw-wisdom";

/// Written beside and renamed, so that processes planning at once never read half a file.
void save_wisdom(const std::filesystem::path& file, int (*export_wisdom)(const char*)) {
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  const std::filesystem::path beside = file.string() + "." + std::to_string(getpid());
  if (export_wisdom(beside.c_str()) != 0) {
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
      fftwf_import_wisdom_from_filename(wisdom_file(single_wisdom).c_str());
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
      save_wisdom(wisdom_file(single_wisdom), fftwf_export_wisdom_to_filename);
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

enum class DoubleLayout { complex_forward, complex_backward, real_forward, real_backward };

/// The same for double precision.
class DoublePlanCache {
 public:
  fftw_plan get(DoubleLayout layout, int length) {
    const std::lock_guard lock(mutex_);
    fftw_plan& plan = plans_[{layout, length}];
    if (plan == nullptr) plan = make(layout, length);
    return plan;
  }

 private:
  static fftw_plan make(DoubleLayout layout, int length) {
    const bool measure = measured_plans();
    if (measure) fftw_import_wisdom_from_filename(wisdom_file(double_wisdom).c_str());
    const unsigned rigor = measure ? FFTW_MEASURE : FFTW_ESTIMATE;
    const AlignedBuffer<std::complex<double>> own_line(static_cast<std::size_t>(length));
    const AlignedBuffer<std::complex<double>> own_bins(static_cast<std::size_t>(length / 2 + 1));
    auto* line = reinterpret_cast<fftw_complex*>(own_line.data());
    auto* real = reinterpret_cast<double*>(own_line.data());
    auto* bins = reinterpret_cast<fftw_complex*>(own_bins.data());
    fftw_plan plan = nullptr;
    switch (layout) {
      case DoubleLayout::complex_forward:
        plan = fftw_plan_dft_1d(length, line, line, FFTW_FORWARD, rigor);
        break;
      case DoubleLayout::complex_backward:
        plan = fftw_plan_dft_1d(length, line, line, FFTW_BACKWARD, rigor);
        break;
      case DoubleLayout::real_forward:
        plan = fftw_plan_dft_r2c_1d(length, real, bins, rigor);
        break;
      case DoubleLayout::real_backward:
        plan = fftw_plan_dft_c2r_1d(length, bins, real, rigor);
        break;
    }
    if (plan == nullptr) throw std::runtime_error(fmt::format("FFTW cannot plan a transform of length {}", length));
    if (measure) save_wisdom(wisdom_file(double_wisdom), fftw_export_wisdom_to_filename);
    return plan;
  }

  std::mutex mutex_;
  std::map<std::pair<DoubleLayout, int>, fftw_plan> plans_;
};

DoublePlanCache& double_plan_cache() {
  static DoublePlanCache& cache = *new DoublePlanCache;  // never destroyed: threads may outlive static destruction
  return cache;
}

}  // namespace

DoubleLineFft::DoubleLineFft(int length, FftDirection direction)
    : plan_(double_plan_cache().get(
          direction == FftDirection::forward ? DoubleLayout::complex_forward : DoubleLayout::complex_backward,
          length)) {}

void DoubleLineFft::operator()(std::complex<double>* line) const {
  auto* bins = reinterpret_cast<fftw_complex*>(line);
  fftw_execute_dft(plan_, bins, bins);
}

RealLineFft::RealLineFft(int length)
    : forward_(double_plan_cache().get(DoubleLayout::real_forward, length)),
      inverse_(double_plan_cache().get(DoubleLayout::real_backward, length)) {}

void RealLineFft::forward(double* line, std::complex<double>* bins) const {
  fftw_execute_dft_r2c(forward_, line, reinterpret_cast<fftw_complex*>(bins));
}

void RealLineFft::inverse(std::complex<double>* bins, double* line) const {
  fftw_execute_dft_c2r(inverse_, reinterpret_cast<fftw_complex*>(bins), line);
}

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
