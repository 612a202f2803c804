#include "methods/base/image_io_tiled.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace textonbench {
namespace {

std::filesystem::path name_beside(const std::filesystem::path& file) {
  return file.parent_path() / fmt::format(".{}.{}.exr", file.stem().string(), getpid());
}

}  // namespace

/// OpenImageIO does not tell when the disk is full; this file remembers.
class TiledImageWriter::WatchedFile final : public OIIO::Filesystem::IOProxy {
 public:
  explicit WatchedFile(const std::filesystem::path& file)
      : IOProxy(file.string(), Write), stream_(file, std::ios::binary), error_(stream_ ? 0 : errno) {}

  const char* proxytype() const override { return "textonbench"; }
  bool seek(int64_t offset) override {
    stream_.seekp(offset);
    m_pos = offset;
    return note();
  }
  size_t write(const void* bytes, size_t count) override {
    stream_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
    m_pos += static_cast<int64_t>(count);
    return note() ? count : 0;
  }
  void close() override {
    stream_.close();
    note();
    m_mode = Closed;
  }
  int failure() const { return error_; }

 private:
  bool note() {
    if (!stream_ && error_ == 0) {
      error_ = errno != 0 ? errno : EIO;
    }
    return error_ == 0;
  }

  std::ofstream stream_;
  int error_ = 0;
};

struct TiledImageWriter::Output {
  explicit Output(std::filesystem::path path) : beside(std::move(path)), file(beside) {}

  void require(bool done, const std::filesystem::path& target) const {
    if (!done || file.failure() != 0) {
      const int error = file.failure() != 0 ? file.failure() : EIO;
      throw std::runtime_error(
          fmt::format("{}: cannot be written ({})", target.string(), std::generic_category().message(error)));
    }
  }

  std::filesystem::path beside;
  WatchedFile file;
  std::unique_ptr<OIIO::ImageOutput> writer;
  std::vector<float> samples;
};

TiledImageWriter::TiledImageWriter(const std::filesystem::path& file, Extent extent, int channels,
                                   std::span<const ImageMap> maps)
    : file_(file), extent_(extent), channels_(channels) {
  if (file.extension() != ".exr") {
    throw std::invalid_argument(fmt::format("{}: a picture of {}x{} is written in tiles; expected an .exr file",
                                            file.string(), extent.width, extent.height));
  }
  std::vector<std::string> names = channel_names(maps);
  if (names.empty() && channels != 1 && channels != 3) {
    throw std::invalid_argument(fmt::format("{}: a picture of {} channels; expected 1 or 3", file.string(), channels));
  }
  if (!names.empty() && names.size() != static_cast<std::size_t>(channels)) {
    throw std::invalid_argument(
        fmt::format("{}: {} channels and maps of {}; expected as many", file.string(), channels, names.size()));
  }
  output_ = std::make_unique<Output>(name_beside(file));
  output_->require(true, file);
  output_->writer = OIIO::ImageOutput::create("picture.exr");
  OIIO::ImageSpec spec(extent.width, extent.height, channels, OIIO::TypeDesc::FLOAT);
  if (!names.empty()) {
    spec.channelnames = std::move(names);
  }
  spec.tile_width = tile;
  spec.tile_height = tile;
  spec.attribute("compression", "none");
  spec.attribute("DateTime", "2000:01:01 00:00:00");  // the same picture has the same bytes
  output_->require(
      output_->writer && output_->writer->set_ioproxy(&output_->file) && output_->writer->open("picture.exr", spec),
      file);
}

TiledImageWriter::~TiledImageWriter() {
  if (output_) {
    output_->writer.reset();
    std::error_code ignored;
    std::filesystem::remove(output_->beside, ignored);
  }
}

int TiledImageWriter::bands() const { return (extent_.height + tile - 1) / tile; }

int TiledImageWriter::band_height(int band) const { return std::min(tile, extent_.height - band * tile); }

void TiledImageWriter::write_band(const Image& band) {
  if (written_ == bands() || band.extent() != Extent{extent_.width, band_height(written_)} ||
      band.channels() != channels_) {
    throw std::invalid_argument(fmt::format("band {} of {}: {}x{} pixels of {} channels do not fit {}x{} of {}",
                                            written_, bands(), band.width(), band.height(), band.channels(),
                                            extent_.width, extent_.height, channels_));
  }
  auto& samples = output_->samples;
  samples.resize(static_cast<std::size_t>(band.extent().area() * channels_));
  auto sample = samples.begin();
  for (int y = 0; y < band.height(); ++y) {
    for (int x = 0; x < band.width(); ++x) {
      for (int c = 0; c < channels_; ++c) {
        *sample++ = band.at(c, x, y);
      }
    }
  }
  const int top = written_ * tile;
  output_->require(output_->writer->write_tiles(0, extent_.width, top, top + band.height(), 0, 1, OIIO::TypeDesc::FLOAT,
                                                samples.data()),
                   file_);
  ++written_;
}

void TiledImageWriter::finish() {
  if (written_ != bands()) {
    throw std::invalid_argument(fmt::format("{} of {} bands were written", written_, bands()));
  }
  const bool closed = output_->writer->close();
  output_->file.close();
  output_->require(closed, file_);
  std::filesystem::rename(output_->beside, file_);
  output_.reset();
}

}  // namespace textonbench
