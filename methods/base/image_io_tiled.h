// Pictures too large for memory, written band by band.
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "methods/base/image.h"
#include "methods/base/image_maps.h"

namespace textonbench {

/// A float32 EXR file of square tiles, uncompressed, that appears complete or not at all: it is written beside under
/// another name and renamed by finish(). Memory: one band.
class TiledImageWriter {
 public:
  static constexpr int tile = 256;  ///< side in pixels; also the height of a band

  /// 1 or 3 channels, or those of `maps`, named as by write_image. Throws std::invalid_argument for another extension
  /// than .exr or number of channels, std::runtime_error when the file cannot be made.
  TiledImageWriter(const std::filesystem::path& file, Extent extent, int channels, std::span<const ImageMap> maps = {});
  TiledImageWriter(const TiledImageWriter&) = delete;
  TiledImageWriter& operator=(const TiledImageWriter&) = delete;
  /// Removes the unfinished file, if finish() was not reached.
  ~TiledImageWriter();

  int bands() const;
  /// Rows [tile * i, tile * i + height) of the picture belong to band i.
  int band_height(int band) const;
  /// The bands in order, each an image of the full width and of band_height() rows. Throws std::runtime_error when the
  /// disk is full.
  void write_band(const Image& band);
  /// Throws std::runtime_error when the file cannot be completed.
  void finish();

 private:
  class WatchedFile;
  struct Output;
  std::unique_ptr<Output> output_;
  std::filesystem::path file_;
  Extent extent_;
  int channels_;
  int written_ = 0;
};

}  // namespace textonbench
