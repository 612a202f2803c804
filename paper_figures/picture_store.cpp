#include "paper_figures/picture_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <set>

#include "experiments/files.h"
#include "methods/base/image_io.h"
#include "methods/base/parallel.h"
#include "paper_figures/anchors.h"

namespace textonbench {
namespace {

constexpr int largest_side = 1024;
constexpr int least_side = 128;
constexpr int side_step = 16;

std::string make_key(const std::string& file, PictureFit fit) {
  return "p-" + anchor_text(std::filesystem::path(file).stem().string()) + (fit == PictureFit::whole ? "-whole" : "");
}

std::size_t encoded_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

}  // namespace

std::optional<std::string> PictureStore::show(const Record& picture, PictureFit fit) {
  const std::string file = picture.value("file", std::string());
  if (!std::filesystem::is_regular_file(results_.path() / file)) return std::nullopt;
  std::string key = make_key(file, fit);
  shown_.insert({key, {file, {picture.value("width", 0), picture.value("height", 0)}, fit}});
  return key;
}

std::optional<std::string> PictureStore::key_of(const std::string& file) const {
  for (const PictureFit fit : {PictureFit::window, PictureFit::whole}) {
    if (std::string key = make_key(file, fit); shown_.contains(key)) return key;
  }
  return std::nullopt;
}

int PictureStore::fitting_side(std::size_t limit) const {
  const auto total = [&](int side) {
    double bytes = 0;
    for (const auto& [key, shown] : shown_) {
      const auto whole = static_cast<double>(encoded_size(std::filesystem::file_size(results_.path() / shown.file)));
      const Extent size = side == 0 ? shown.size : shown_size(shown.size, side, shown.fit);
      bytes +=
          whole * static_cast<double>(size.area()) / static_cast<double>(std::max<std::int64_t>(1, shown.size.area()));
    }
    return bytes;
  };
  if (total(0) <= static_cast<double>(limit)) return 0;
  int side = largest_side;
  while (side > least_side && total(side) > static_cast<double>(limit)) side -= side_step;
  return side;
}

PictureStore::Embedded PictureStore::load(const Shown& shown, int side) const {
  const std::filesystem::path file = results_.path() / shown.file;
  const auto uri = [](const std::string& bytes) { return "data:image/png;base64," + base64(bytes); };
  if (side == 0 || shown_size(shown.size, side, shown.fit) == shown.size) return {uri(read_file(file)), shown.size};
  const Image part = shown_picture(read_image(file).image, side, shown.fit);
  const std::filesystem::path draft =
      std::filesystem::temp_directory_path() /
      fmt::format("textonbench_{}_{}.png", ::getpid(), make_key(shown.file.string(), shown.fit));
  write_image(part, draft);
  Embedded embedded{uri(read_file(draft)), part.extent()};
  std::filesystem::remove(draft);
  return embedded;
}

std::string PictureStore::embed(const std::string& page, int side) const {
  std::vector<std::pair<std::string, const Shown*>> order;
  for (const auto& [key, shown] : shown_) order.emplace_back(key, &shown);
  std::vector<Embedded> loaded(order.size());
  parallel_for(static_cast<int>(order.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    loaded[k] = load(*order[k].second, side);
  });

  static constexpr std::string_view mark = "data-picture=\"";
  std::string result;
  std::set<std::string> placed;
  std::size_t rest = 0;
  for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, rest)) {
    const std::size_t first = at + mark.size();
    const std::size_t last = page.find('"', first);
    const std::string key = page.substr(first, last - first);
    const auto found = std::ranges::find(order, key, &std::pair<std::string, const Shown*>::first);
    const Embedded& picture = loaded.at(static_cast<std::size_t>(found - order.begin()));
    result.append(page, rest, at - rest);
    result += placed.insert(key).second ? fmt::format("id=\"{}\" src=\"{}\"", key, picture.uri)
                                        : fmt::format("data-same=\"{}\"", key);
    result += fmt::format(" width=\"{}\" height=\"{}\"", picture.size.width, picture.size.height);
    rest = last + 1;
  }
  return result.append(page, rest, std::string::npos);
}

std::string base64(std::string_view bytes) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(encoded_size(bytes.size()));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t taken = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < taken ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) text += k <= taken ? digits[group >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

}  // namespace textonbench
