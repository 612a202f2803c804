#include "methods/base/block_rows.h"

#include <algorithm>
#include <optional>

#include "methods/base/lanes.h"
#include "methods/base/parallel.h"

namespace textonbench {
namespace {

constexpr int group_rows = 2 * block_lines;  ///< row i is the real part of line i, row 8 + i its imaginary part

/// Some consecutive rows of one channel, of which the last group may have fewer than sixteen.
struct RowGroup {
  int channel, first, count;
};

// Rows of images have room for whole vectors, so what lies beyond their width may be read and written too.

/// Rows of the group into the block, padded by zeros to `length` numbers a line.
[[gnu::always_inline]] inline void gather(const Image& image, const RowGroup& group, int length, float* block) {
  for (int x = 0; x < image.width(); x += block_lines) {
    const int columns = std::min(block_lines, image.width() - x);
    for (int part = 0; part < group_rows; part += block_lines) {
      FloatLanes lanes[block_lines] = {};
      for (int i = 0; i < block_lines && part + i < group.count; ++i) {
        load(image.row(group.channel, group.first + part + i).data() + x, lanes[i]);
      }
      transpose(lanes);
      for (int j = 0; j < columns; ++j) {
        store(lanes[j], block + (x + j) * block_row + part);
      }
    }
  }
  std::fill(block + image.width() * block_row, block + length * block_row, 0.0F);
}

/// The first numbers of the lines into the rows.
[[gnu::always_inline]] inline void scatter(const float* block, const RowGroup& group, Image& image) {
  for (int x = 0; x < image.width(); x += block_lines) {
    const int columns = std::min(block_lines, image.width() - x);
    for (int part = 0; part < group_rows; part += block_lines) {
      FloatLanes lanes[block_lines] = {};
      for (int j = 0; j < columns; ++j) {
        load(block + (x + j) * block_row + part, lanes[j]);
      }
      transpose(lanes);
      for (int i = 0; i < block_lines && part + i < group.count; ++i) {
        store(lanes[i], image.row(group.channel, group.first + part + i).data() + x);
      }
    }
  }
}

/// Bins of eight neighboring columns, one vector a column: of rows i (a) and 8 + i (b).
struct Bins {
  FloatLanes a_re[block_lines], a_im[block_lines], b_re[block_lines], b_im[block_lines];
};

[[gnu::always_inline]] inline void transpose_bins(Bins& bins) {
  transpose(bins.a_re);
  transpose(bins.a_im);
  transpose(bins.b_re);
  transpose(bins.b_im);
}

/// â(k) = (ẑ(k) + conj ẑ(−k)) / 2, b̂(k) = (ẑ(k) − conj ẑ(−k)) / 2i.
[[gnu::always_inline]] inline void split(const float* block, const RowGroup& group, const ColumnTiles& spectra) {
  const int length = spectra.length();
  for (int i = 0; i < spectra.count(); ++i) {
    Bins bins = {};
    for (int j = 0; j < block_lines && 2 * (block_lines * i + j) <= length; ++j) {
      const int k = block_lines * i + j;
      const float* plus = block + k * block_row;
      const float* minus = block + (k == 0 ? 0 : length - k) * block_row;
      FloatLanes plus_re, plus_im, minus_re, minus_im;
      load(plus, plus_re);
      load(plus + block_lines, plus_im);
      load(minus, minus_re);
      load(minus + block_lines, minus_im);
      bins.a_re[j] = 0.5F * (plus_re + minus_re);
      bins.a_im[j] = 0.5F * (plus_im - minus_im);
      bins.b_re[j] = 0.5F * (plus_im + minus_im);
      bins.b_im[j] = 0.5F * (minus_re - plus_re);
    }
    transpose_bins(bins);
    float* a = spectra.tile(i, group.channel) + group.first * block_row;
    float* b = a + block_lines * block_row;
    for (int y = 0; y < std::min(block_lines, group.count); ++y) {
      store(bins.a_re[y], a + y * block_row);
      store(bins.a_im[y], a + y * block_row + block_lines);
    }
    for (int y = 0; y < group.count - block_lines; ++y) {
      store(bins.b_re[y], b + y * block_row);
      store(bins.b_im[y], b + y * block_row + block_lines);
    }
  }
}

/// ẑ(k) = â(k) + i b̂(k), of which the imaginary parts of â and b̂ are zero where k = −k.
[[gnu::always_inline]] inline void join(const ColumnTiles& spectra, const RowGroup& group, float* block) {
  const int length = spectra.length();
  for (int i = 0; i < spectra.count(); ++i) {
    Bins bins = {};
    const float* a = spectra.tile(i, group.channel) + group.first * block_row;
    const float* b = a + block_lines * block_row;
    for (int y = 0; y < std::min(block_lines, group.count); ++y) {
      load(a + y * block_row, bins.a_re[y]);
      load(a + y * block_row + block_lines, bins.a_im[y]);
    }
    for (int y = 0; y < group.count - block_lines; ++y) {
      load(b + y * block_row, bins.b_re[y]);
      load(b + y * block_row + block_lines, bins.b_im[y]);
    }
    transpose_bins(bins);
    for (int j = 0; j < block_lines && 2 * (block_lines * i + j) <= length; ++j) {
      const int k = block_lines * i + j;
      float* plus = block + k * block_row;
      if (k == 0 || 2 * k == length) {
        store(bins.a_re[j], plus);
        store(bins.b_re[j], plus + block_lines);
      } else {
        float* minus = block + (length - k) * block_row;
        store(bins.a_re[j] - bins.b_im[j], plus);
        store(bins.a_im[j] + bins.b_re[j], plus + block_lines);
        store(bins.a_re[j] + bins.b_im[j], minus);
        store(bins.b_re[j] - bins.a_im[j], minus + block_lines);
      }
    }
  }
}

__attribute__((target_clones("default", "avx2"))) void gather_rows(const Image& image, const RowGroup& group,
                                                                   int length, float* block) {
  gather(image, group, length, block);
}

__attribute__((target_clones("default", "avx2"))) void scatter_rows(const float* block, const RowGroup& group,
                                                                    Image& image) {
  scatter(block, group, image);
}

__attribute__((target_clones("default", "avx2"))) void split_block(const float* block, const RowGroup& group,
                                                                   const ColumnTiles& spectra) {
  split(block, group, spectra);
}

__attribute__((target_clones("default", "avx2"))) void join_block(const ColumnTiles& spectra, const RowGroup& group,
                                                                  float* block) {
  join(spectra, group, block);
}

/// Calls body(group) for all groups of rows of every channel.
template <class Body>
void for_row_groups(const Image& image, const Body& body) {
  const int groups = (image.height() + group_rows - 1) / group_rows;
  parallel_for(image.channels() * groups, [&](int i) {
    const int first = i % groups * group_rows;
    body(RowGroup{i / groups, first, std::min(group_rows, image.height() - first)});
  });
}

}  // namespace

ColumnTiles::ColumnTiles(int length, int rows, int channels)
    : length_(length),
      rows_(rows),
      channels_(channels),
      stride_((rows | 1) * block_row),  // an odd number of cache lines, for a power of two would fill few of its sets
      data_(static_cast<std::size_t>(std::ptrdiff_t{count()} * channels * stride_)) {}

ColumnTiles transform_rows(const Image& image, int length) {
  ColumnTiles spectra(length, image.height(), image.channels());
  const BlockFft fft(length);
  const std::ptrdiff_t size = length * block_row;
  for_row_groups(image, [&](const RowGroup& group) {
    float* samples = scratch_floats(static_cast<std::size_t>(3 * size));
    float* bins = samples + size;
    gather_rows(image, group, length, samples);
    fft.forward(samples, bins, bins + size);
    split_block(bins, group, spectra);
  });
  return spectra;
}

void transform_rows_back(const ColumnTiles& spectra, Image& image) {
  const BlockFft fft(spectra.length());
  const std::ptrdiff_t size = spectra.length() * block_row;
  for_row_groups(image, [&](const RowGroup& group) {
    float* bins = scratch_floats(static_cast<std::size_t>(3 * size));
    float* samples = bins + size;
    join_block(spectra, group, bins);
    fft.backward(bins, samples, samples + size);
    scatter_rows(samples, group, image);
  });
}

float* scratch_floats(std::size_t size) {
  thread_local std::optional<AlignedBuffer<float>> room;
  if (!room || room->size() < size) {
    room.emplace(size);
  }
  return room->data();  // NOLINT(clang-analyzer-unix.Malloc): the freed room is the one that was replaced
}

}  // namespace textonbench
