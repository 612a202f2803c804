// Pictures on their way into the report.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/record.h"
#include "paper_figures/picture_view.h"

namespace textonbench {

/// Collects the pictures that a page shows, then puts their bytes into it, each once. A page shows a picture by
/// <img data-picture="KEY">; `embed` gives the first such element the bytes and the others the attribute `data-same`,
/// from which the page's script takes them.
class PictureStore {
 public:
  explicit PictureStore(const ResultsFolder& results) : results_(results) {}

  /// Notes an entry {file, width, height} of a record's `pictures`; returns its key, or nothing when the file is gone.
  std::optional<std::string> show(const Record& picture, PictureFit fit);
  /// Key under which the page shows this file, if it does.
  std::optional<std::string> key_of(const std::string& file) const;

  /// Largest side that pictures may have so that all of them take about `limit` bytes of the page; 0 when they fit as
  /// they are. At least 128.
  int fitting_side(std::size_t limit = std::size_t{22} << 20) const;

  /// The page with pictures in it, no side longer than `side` unless that is 0. Files that fit are embedded as they
  /// are.
  std::string embed(const std::string& page, int side) const;

 private:
  struct Shown {
    std::filesystem::path file;
    Extent size;
    PictureFit fit;
  };
  /// Attributes of the <img> elements of one picture.
  struct Embedded {
    std::string uri;
    Extent size;
  };
  Embedded load(const Shown& shown, int side) const;

  const ResultsFolder& results_;
  std::map<std::string, Shown> shown_;
};

/// RFC 4648 with padding.
std::string base64(std::string_view bytes);

}  // namespace textonbench
