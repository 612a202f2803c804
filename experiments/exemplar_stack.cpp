#include "experiments/exemplar_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace textonbench {
namespace {

/// Where a map comes from, for messages.
std::string origin_of_map(const ExemplarInfo& info) { return info.file.empty() ? info.name : info.file.string(); }

}  // namespace

ExemplarInfo find_stack(const ExemplarCatalog& catalog, const std::string& names) {
  ExemplarInfo info{.name = {},
                    .available = true,
                    .file = {},
                    .source = "stack of maps",
                    .licence = {},
                    .how_to_get = {},
                    .expected_sha256 = {},
                    .tags = {}};
  std::istringstream parts(names + '+');
  for (std::string part; std::getline(parts, part, '+');) {
    if (part.empty()) {
      throw std::invalid_argument(
          fmt::format("exemplar \"{}\": expected names or files of maps on both sides of \"+\"", names));
    }
    const ExemplarInfo& map = info.maps.emplace_back(find_exemplar(catalog, part));
    info.name += (info.name.empty() ? "" : "+") + map.name;
  }
  return info;
}

Exemplar load_stack(const ExemplarInfo& info, std::vector<std::string>* notes, const ReadOptions& options) {
  std::vector<Image> pictures;
  std::vector<ImageMap> maps;
  int channels = 0;
  for (const ExemplarInfo& part : info.maps) {
    Exemplar loaded = load_exemplar(part, notes, options);
    if (!pictures.empty() && loaded.pixels.extent() != pictures.front().extent()) {
      throw std::invalid_argument(fmt::format("{} has {}x{} pixels and {} has {}x{}: expected maps of one size",
                                              origin_of_map(info.maps.front()), pictures.front().width(),
                                              pictures.front().height(), origin_of_map(part), loaded.pixels.width(),
                                              loaded.pixels.height()));
    }
    if (loaded.maps.empty()) {
      loaded.maps.push_back({part.name, loaded.pixels.channels()});
    }
    for (ImageMap& map : loaded.maps) {
      if (std::ranges::find(maps, map.name, &ImageMap::name) != maps.end()) {
        throw std::invalid_argument(
            fmt::format("exemplar \"{}\" has two maps named \"{}\": expected names that differ", info.name, map.name));
      }
      channels += map.channels;
      maps.push_back(std::move(map));
    }
    pictures.push_back(std::move(loaded.pixels));
  }
  if (channels > Image::max_channels) {
    throw std::invalid_argument(fmt::format("exemplar \"{}\" has {} channels in {} maps: expected at most {}",
                                            info.name, channels, maps.size(), Image::max_channels));
  }
  return {info.name, stack_images(pictures), exemplar_sha256(info), std::move(maps)};
}

}  // namespace textonbench
