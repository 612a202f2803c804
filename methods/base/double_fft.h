// Double-precision Fourier transforms of real fields that are zero outside a box and wanted in that box only, for
// linear systems whose condition number is beyond single precision. Scaling as in fft.h.
#pragma once

#include <complex>
#include <functional>
#include <span>
#include <vector>

#include "methods/base/image.h"

namespace textonbench {

/// Real double-precision raster of several planes without padding: channel c, row y at data[(c * height + y) * width].
struct Planes {
  Planes() = default;
  Planes(Extent size, int number)
      : extent(size), channels(number), data(static_cast<std::size_t>(size.area() * number)) {}

  double* row(int channel, int y) { return data.data() + (std::int64_t{channel} * extent.height + y) * extent.width; }
  const double* row(int channel, int y) const {
    return data.data() + (std::int64_t{channel} * extent.height + y) * extent.width;
  }

  Extent extent;
  int channels = 0;
  std::vector<double> data;
};

/// Columns first … first + count − 1 of a half spectrum, all channels: bins ky = 0 … H − 1 of a column follow each
/// other. The last of the count may lie beyond W/2; they hold nothing.
struct SpectrumColumns {
  static constexpr int count = 4;

  int first = 0;
  int height = 0;
  std::complex<double>* bins = nullptr;

  std::complex<double>* column(int channel, int i) const {
    return bins + (std::ptrdiff_t{channel} * count + i) * height;
  }
};

/// Plans for a grid and the box in its corner. Immutable; threads may share it.
class BoxTransform {
 public:
  /// Throws std::invalid_argument when the box is larger than the grid.
  BoxTransform(Extent grid, Extent box);

  Extent grid() const { return grid_; }
  Extent box() const { return box_; }
  /// Stored columns of a half spectrum, W/2 + 1.
  int columns() const { return grid_.width / 2 + 1; }

  /// Called once for every block of columns, from several threads at once.
  using ColumnMap = std::function<void(const SpectrumColumns&)>;

  /// Buffers of one call, reused by later ones. For one caller at a time.
  using Workspace = std::vector<std::complex<double>>;

  /// Replaces the planes, of size box(), by the box of W H times the inverse transform of map(their spectrum on the
  /// grid). A pair of transforms a channel; rows outside the box are never transformed, and columns are transformed,
  /// mapped and transformed back while they are in cache.
  void map(Planes& fields, const ColumnMap& map, Workspace& workspace) const;

  /// Gives the spectrum to `visit` and nothing back.
  void forward(const Planes& fields, const ColumnMap& visit, Workspace& workspace) const;
  /// Fills the planes with the box of W H times the inverse transform of the spectrum that `source` writes.
  void inverse(const ColumnMap& source, Planes& fields, Workspace& workspace) const;

 private:
  void rows_forward(const Planes& fields, Workspace& half) const;
  void rows_inverse(Workspace& half, Planes& fields) const;
  enum class Passes { forward, inverse, both };
  void all_columns(Passes passes, int channels, const ColumnMap& map, Workspace& half) const;

  Extent grid_, box_;
};

}  // namespace textonbench
