#include "paper_figures/anchors.h"

#include <fmt/format.h>

namespace textonbench {

std::string anchor_text(std::string_view text) {
  std::string anchor;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    anchor += plain ? std::string(1, c) : fmt::format("-{:02x}", static_cast<unsigned char>(c));
  }
  return anchor;
}

}  // namespace textonbench
