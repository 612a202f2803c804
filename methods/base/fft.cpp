#include "methods/base/fft.h"

#include <fftw3.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "methods/base/parallel.h"

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

/// In-place complex plans by length, made once. FFTW's planner is not safe between threads; executing a plan is.
class PlanCache {
 public:
  /// `sign` is FFTW_FORWARD or FFTW_BACKWARD.
  fftwf_plan get(int length, int sign) {
    const std::lock_guard lock(mutex_);
    fftwf_plan& plan = plans_[{length, sign}];
    if (plan == nullptr) {
      plan = make(length, sign);
    }
    return plan;
  }

 private:
  static fftwf_plan make(int length, int sign) {
    const bool measure = measured_plans();
    if (measure) {
      fftwf_import_wisdom_from_filename(wisdom_file().c_str());
    }
    // Planning with timing overwrites its array, so it gets its own; plans are then executed on any array of the same
    // alignment.
    const AlignedBuffer<std::complex<float>> bins(static_cast<std::size_t>(length));
    auto* complex_bins = reinterpret_cast<fftwf_complex*>(bins.data());
    fftwf_plan plan =
        fftwf_plan_dft_1d(length, complex_bins, complex_bins, sign, measure ? FFTW_MEASURE : FFTW_ESTIMATE);
    if (plan == nullptr) {
      throw std::runtime_error(fmt::format("FFTW cannot plan a transform of length {}", length));
    }
    if (measure) {
      save_wisdom();
    }
    return plan;
  }

  std::mutex mutex_;
  std::map<std::pair<int, int>, fftwf_plan> plans_;
};

PlanCache& plan_cache() {
  static PlanCache& cache = *new PlanCache;  // never destroyed: threads may outlive static destruction
  return cache;
}

void execute(fftwf_plan plan, std::complex<float>* in_place) {
  auto* bins = reinterpret_cast<fftwf_complex*>(in_place);
  fftwf_execute_dft(plan, bins, bins);
}

constexpr int block_width = ColumnBlock::width;

// Four bins as four 64-bit lanes, for the compiler to keep in vector registers.
using Lanes [[gnu::vector_size(32)]] = std::int64_t;

/// out[i * out_stride + j] = in[j * in_stride + i], i, j < 4.
inline __attribute__((always_inline)) void transpose_tile(const std::complex<float>* in, std::ptrdiff_t in_stride,
                                                          std::complex<float>* out, std::ptrdiff_t out_stride) {
  Lanes r[4];
  for (int j = 0; j < 4; ++j) {
    std::memcpy(&r[j], in + j * in_stride, sizeof(Lanes));
  }
  const Lanes t[4] = {__builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7),
                      __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7)};
  const Lanes c[4] = {__builtin_shufflevector(t[0], t[2], 0, 1, 4, 5), __builtin_shufflevector(t[1], t[3], 0, 1, 4, 5),
                      __builtin_shufflevector(t[0], t[2], 2, 3, 6, 7), __builtin_shufflevector(t[1], t[3], 2, 3, 6, 7)};
  for (int i = 0; i < 4; ++i) {
    std::memcpy(static_cast<void*>(out + i * out_stride), &c[i], sizeof(Lanes));
  }
}

/// out[i * out_stride + j] = in[j * in_stride + i], j < rows, i < columns.
__attribute__((target_clones("default", "avx2"))) void transpose(const std::complex<float>* in,
                                                                 std::ptrdiff_t in_stride, int rows, int columns,
                                                                 std::complex<float>* out, std::ptrdiff_t out_stride) {
  constexpr int ahead = 32;  // rows: far apart in memory, so no prefetcher of the processor follows them
  const int whole_rows = rows / 4 * 4;
  const int whole_columns = columns / 4 * 4;
  // Either way all of a cache line is used while it is at hand: eight bins are the shorter side.
  if (rows > columns) {
    for (int j = 0; j < whole_rows; j += 4) {
      for (int k = 0; k < 4 && j + k + ahead < rows; ++k) {
        __builtin_prefetch(in + (j + k + ahead) * in_stride);
      }
      for (int i = 0; i < whole_columns; i += 4) {
        transpose_tile(in + j * in_stride + i, in_stride, out + i * out_stride + j, out_stride);
      }
    }
  } else {
    for (int i = 0; i < whole_columns; i += 4) {
      for (int k = 0; k < 4 && i + k + ahead < columns; ++k) {
        __builtin_prefetch(out + (i + k + ahead) * out_stride, 1);
      }
      for (int j = 0; j < whole_rows; j += 4) {
        transpose_tile(in + j * in_stride + i, in_stride, out + i * out_stride + j, out_stride);
      }
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = j < whole_rows ? whole_columns : 0; i < columns; ++i) {
      out[i * out_stride + j] = in[j * in_stride + i];
    }
  }
}

// Two real rows a and b make one complex row z = a + i b, whose transform is taken apart by symmetry:
// â(k) = (ẑ(k) + conj ẑ(−k)) / 2, b̂(k) = (ẑ(k) − conj ẑ(−k)) / 2i. FFTW transforms one complex row much faster than
// two real ones. `b` is null for a last row without a partner.

void join_rows(const float* a, const float* b, int length, std::complex<float>* z) {
  for (int x = 0; x < length; ++x) {
    z[x] = {a[x], b == nullptr ? 0.0F : b[x]};
  }
}

void split_rows(const std::complex<float>* z, int length, float* a, float* b) {
  for (int x = 0; x < length; ++x) {
    a[x] = z[x].real();
  }
  for (int x = 0; b != nullptr && x < length; ++x) {
    b[x] = z[x].imag();
  }
}

void join_spectra(const std::complex<float>* a, const std::complex<float>* b, int length, std::complex<float>* z) {
  const std::complex<float> zero = 0;
  const std::ptrdiff_t step = b == nullptr ? 0 : 1;
  const std::complex<float>* other = b == nullptr ? &zero : b;
  z[0] = {a[0].real(), other[0].real()};
  for (int k = 1; 2 * k < length; ++k) {
    const std::complex<float> bin_a = a[k];
    const std::complex<float> bin_b = other[k * step];
    z[k] = {bin_a.real() - bin_b.imag(), bin_a.imag() + bin_b.real()};
    z[length - k] = {bin_a.real() + bin_b.imag(), bin_b.real() - bin_a.imag()};
  }
  if (length % 2 == 0) {
    z[length / 2] = {a[length / 2].real(), other[length / 2 * step].real()};
  }
}

void split_spectra(const std::complex<float>* z, int length, std::complex<float>* a, std::complex<float>* b) {
  for (int k = 0; 2 * k <= length; ++k) {
    const std::complex<float> plus = z[k];
    const std::complex<float> minus = z[k == 0 ? 0 : length - k];
    a[k] = {0.5F * (plus.real() + minus.real()), 0.5F * (plus.imag() - minus.imag())};
    if (b != nullptr) {
      b[k] = {0.5F * (plus.imag() + minus.imag()), 0.5F * (minus.real() - plus.real())};
    }
  }
}

int block_count(Extent raster) { return raster.width / 2 / block_width + 1; }

/// A block of this thread's own, kept between calls for the shape that was transformed last.
const ColumnBlock& scratch_block(Extent raster, int channels) {
  thread_local std::optional<ColumnBlock> block;
  thread_local std::pair<int, int> shape;
  if (!block || shape != std::pair(raster.height, channels)) {
    block.emplace(raster, channels);
    shape = {raster.height, channels};
  }
  return *block;
}

std::complex<float>* scratch_row(int length) {
  thread_local std::optional<AlignedBuffer<std::complex<float>>> row;
  if (!row || row->size() < static_cast<std::size_t>(length)) {
    row.emplace(static_cast<std::size_t>(length));
  }
  return row->data();  // NOLINT(clang-analyzer-unix.Malloc): the freed row is the one that was replaced
}

/// Calls body(channel, y) for y = 0, 2, 4, … of every channel.
template <class Body>
void for_row_pairs(Extent raster, int channels, const Body& body) {
  const int pairs = (raster.height + 1) / 2;
  parallel_for(channels * pairs, [&](int i) { body(i / pairs, 2 * (i % pairs)); });
}

}  // namespace

Spectrum Spectrum::uninitialized(Extent raster, int channels) {
  if (raster.width < 1 || raster.height < 1) {
    throw std::invalid_argument(
        fmt::format("spectrum of a raster of {}x{}: both sides must be at least 1", raster.width, raster.height));
  }
  if (raster.area() > Image::max_pixels) {
    throw std::invalid_argument(
        fmt::format("spectrum of a raster of {}x{}: at most 2^40 pixels are possible", raster.width, raster.height));
  }
  if (channels < 1 || channels > Image::max_channels) {
    throw std::invalid_argument(
        fmt::format("spectrum of {} channels: expected 1 to {}", channels, Image::max_channels));
  }
  Spectrum spectrum;
  spectrum.raster_ = raster;
  spectrum.channels_ = channels;
  spectrum.data_ =
      AlignedBuffer<std::complex<float>>(static_cast<std::size_t>(spectrum.row_stride() * raster.height * channels));
  return spectrum;
}

Spectrum::Spectrum(Extent raster, int channels) : Spectrum(uninitialized(raster, channels)) { data_.set_zero(); }

ColumnBlock::ColumnBlock(Extent raster, int channels)
    : stride_((raster.height + 7) / 8 * 8 + 8),  // not a power of two, which would fill few sets of the cache
      data_(static_cast<std::size_t>(stride_ * block_width * channels)) {
  data_.set_zero();
}

void copy_columns(const Spectrum& spectrum, int channel, int first, const ColumnBlock& block) {
  transpose(spectrum.row(channel, 0).data() + first, spectrum.row_stride(), spectrum.rows(), block_width,
            block.column(channel, 0), block.stride());
}

Spectrum forward_fft(const Image& image) {
  Spectrum spectrum = Spectrum::uninitialized(image.extent(), image.channels());
  const auto [length, height] = image.extent();
  const fftwf_plan rows = plan_cache().get(length, FFTW_FORWARD);
  for_row_pairs(image.extent(), image.channels(), [&, length = length, height = height](int c, int y) {
    const bool partner = y + 1 < height;
    std::complex<float>* z = scratch_row(length);
    join_rows(image.row(c, y).data(), partner ? image.row(c, y + 1).data() : nullptr, length, z);
    execute(rows, z);
    split_spectra(z, length, spectrum.row(c, y).data(), partner ? spectrum.row(c, y + 1).data() : nullptr);
  });
  const fftwf_plan columns = plan_cache().get(height, FFTW_FORWARD);
  const int blocks = block_count(image.extent());
  parallel_for(image.channels() * blocks, [&, height = height](int i) {
    const ColumnBlock& block = scratch_block(image.extent(), 1);
    std::complex<float>* bins = spectrum.row(i / blocks, 0).data() + std::ptrdiff_t{i % blocks} * block_width;
    transpose(bins, spectrum.row_stride(), height, block_width, block.column(0, 0), block.stride());
    for (int k = 0; k < block_width; ++k) {
      execute(columns, block.column(0, k));
    }
    transpose(block.column(0, 0), block.stride(), block_width, height, bins, spectrum.row_stride());
  });
  return spectrum;
}

Image unnormalized_inverse_fft(Extent raster, int channels, const ColumnSource& source) {
  // Columns are transformed in small blocks and stored in the memory of the image, each row of which holds half a
  // spectrum until it is transformed itself. Image rows have room for whole blocks.
  Image image = Image::uninitialized(raster, channels);
  const fftwf_plan columns = plan_cache().get(raster.height, FFTW_BACKWARD);
  parallel_for(block_count(raster), [&](int i) {
    const ColumnBlock& block = scratch_block(raster, channels);
    source(i * block_width, block);
    for (int c = 0; c < channels; ++c) {
      for (int k = 0; k < block_width; ++k) {
        execute(columns, block.column(c, k));
      }
      transpose(block.column(c, 0), block.stride(), block_width, raster.height,
                reinterpret_cast<std::complex<float>*>(image.plane(c)) + std::ptrdiff_t{i} * block_width,
                image.row_stride() / 2);
    }
  });
  const fftwf_plan rows = plan_cache().get(raster.width, FFTW_BACKWARD);
  for_row_pairs(raster, channels, [&](int c, int y) {
    float* a = image.row(c, y).data();
    float* b = y + 1 < raster.height ? image.row(c, y + 1).data() : nullptr;
    std::complex<float>* z = scratch_row(raster.width);
    join_spectra(reinterpret_cast<const std::complex<float>*>(a), reinterpret_cast<const std::complex<float>*>(b),
                 raster.width, z);
    execute(rows, z);
    split_rows(z, raster.width, a, b);
  });
  return image;
}

Image inverse_fft(const Spectrum& spectrum) {
  Image image =
      unnormalized_inverse_fft(spectrum.raster(), spectrum.channels(), [&](int first, const ColumnBlock& block) {
        for (int c = 0; c < spectrum.channels(); ++c) {
          copy_columns(spectrum, c, first, block);
        }
      });
  const auto scale = static_cast<float>(1.0 / static_cast<double>(spectrum.raster().area()));
  parallel_for(image.channels() * image.height(), [&](int i) {
    for (float& v : image.row(i / image.height(), i % image.height())) {
      v *= scale;
    }
  });
  return image;
}

int good_fft_size(int minimum) {
  constexpr int most = 1 << 30;
  if (minimum < 1 || minimum > most) {
    throw std::invalid_argument(fmt::format("size of at least {}: expected a number in [1, {}]", minimum, most));
  }
  for (int n = minimum;; ++n) {
    int rest = n;
    for (const int factor : {2, 3, 5, 7}) {
      while (rest % factor == 0) {
        rest /= factor;
      }
    }
    if (rest == 1) {
      return n;
    }
  }
}

const char* fft_plan_rigor() { return measured_plans() ? "measure" : "estimate"; }

const char* fft_library_version() { return fftwf_version; }

}  // namespace textonbench
