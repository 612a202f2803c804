#include "experiments/texton_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/files.h"

namespace textonbench {
namespace {

constexpr int format_version = 1;
constexpr int highest_order = 5;
constexpr int largest_side = 1 << 15;

/// The lines of a text, one after the other.
class TextonReader {
 public:
  TextonReader(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {}

  std::string_view line(const char* expected) {
    ++number_;
    if (at_ >= text_.size()) refuse(fmt::format("the file ends here, expected {}", expected));
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view found = std::string_view(text_).substr(at_, end - at_);
    if (found.ends_with('\r')) found.remove_suffix(1);
    at_ = end + 1;
    return found;
  }

  /// `count` finite numbers, and nothing else, on the next line.
  template <class Number>
  std::vector<Number> numbers(std::size_t count, const char* expected) {
    const std::string_view found = line(expected);
    std::vector<Number> values;
    values.reserve(count);
    const char* at = found.data();
    const char* const end = at + found.size();
    while (true) {
      while (at != end && (*at == ' ' || *at == '\t')) ++at;
      if (at == end) break;
      Number value{};
      const auto [next, error] = std::from_chars(at, end, value);
      if (error != std::errc() || (next != end && *next != ' ' && *next != '\t') ||
          !std::isfinite(static_cast<double>(value))) {
        refuse(fmt::format("\"{}\": expected {}", found, expected));
      }
      values.push_back(value);
      at = next;
    }
    if (values.size() != count) refuse(fmt::format("\"{}\": expected {}", found, expected));
    return values;
  }

  /// Characters that no line has taken yet.
  std::size_t left() const { return text_.size() - std::min(at_, text_.size()); }

  /// What is left, as one line.
  std::string rest() {
    std::string found(at_ < text_.size() ? line("the exemplar's name") : std::string_view());
    if (text_.find_first_not_of(" \t\r\n", at_) != std::string::npos) {
      ++number_;
      refuse("the file goes on after the line that names the exemplar");
    }
    return found;
  }

  [[noreturn]] void refuse(const std::string& message) const {
    throw std::invalid_argument(fmt::format("{}:{}: {}", name_, number_, message));
  }

 private:
  std::string name_, text_;
  std::size_t at_ = 0;
  int number_ = 0;
};

/// A pixel of the frame that is not zero.
std::optional<std::pair<int, int>> spoiled_frame(const Image& image, int order) {
  const int frame = (order + 1) / 2;
  for (int c = 0; c < image.channels(); ++c) {
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const bool inside = x >= frame && x < image.width() - frame && y >= frame && y < image.height() - frame;
        if (!inside && image.at(c, x, y) != 0) return std::pair(x, y);
      }
    }
  }
  return std::nullopt;
}

std::string frame_message(std::pair<int, int> pixel, int order) {
  return fmt::format("the coefficient at ({}, {}) is not zero: expected a frame of {} zeros on every side for order {}",
                     pixel.first, pixel.second, (order + 1) / 2, order);
}

}  // namespace

TextonFile read_texton_file(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw std::invalid_argument(fmt::format("{}: no such file", file.string()));
  TextonReader reader(file.string(), read_file(file));
  TextonFile texton;
  if (const std::string_view magic = reader.line("TEXTON"); magic != "TEXTON") {
    reader.refuse(fmt::format("\"{}\": expected the word TEXTON, the start of a texton file", magic.substr(0, 20)));
  }
  if (const int version = reader.numbers<int>(1, "the version of the format")[0]; version != format_version) {
    reader.refuse(fmt::format("version {} of the format: expected {}", version, format_version));
  }
  texton.order = reader.numbers<int>(1, "the order of the B-spline, from 0 to 5")[0];
  if (texton.order < 0 || texton.order > highest_order) {
    reader.refuse(fmt::format("order {}: expected 0 to {}", texton.order, highest_order));
  }
  const std::vector<double> mean = reader.numbers<double>(3, "the mean: three numbers");
  std::copy(mean.begin(), mean.end(), texton.mean.begin());
  const std::vector<int> size = reader.numbers<int>(2, "width and height");
  if (size[0] < 1 || size[1] < 1 || size[0] > largest_side || size[1] > largest_side) {
    reader.refuse(fmt::format("{} x {}: expected sides from 1 to {}", size[0], size[1], largest_side));
  }
  constexpr std::size_t shortest_line = 6;  // "0 0 0\n"
  if (reader.left() / shortest_line < static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1])) {
    reader.refuse(fmt::format("{} x {} coefficients announced and {} bytes left: the file is cut short", size[0],
                              size[1], reader.left()));
  }
  texton.coefficients = Image({size[0], size[1]}, 3);
  for (int y = size[1] - 1; y >= 0; --y) {
    for (int x = 0; x < size[0]; ++x) {
      const std::vector<float> pixel = reader.numbers<float>(3, "three finite coefficients");
      for (int c = 0; c < 3; ++c) texton.coefficients.at(c, x, y) = pixel[static_cast<std::size_t>(c)];
    }
  }
  texton.source = reader.rest();
  if (const auto pixel = spoiled_frame(texton.coefficients, texton.order)) {
    throw std::invalid_argument(fmt::format("{}: {}", file.string(), frame_message(*pixel, texton.order)));
  }
  return texton;
}

void write_texton_file(const TextonFile& texton, const std::filesystem::path& file) {
  const Image& image = texton.coefficients;
  const auto refuse = [&](const std::string& message) {
    throw std::invalid_argument(fmt::format("{}: {}", file.string(), message));
  };
  if (image.channels() != 3) refuse(fmt::format("a texton of {} channels: expected 3", image.channels()));
  if (const auto pixel = spoiled_frame(image, texton.order)) refuse(frame_message(*pixel, texton.order));
  std::string text = fmt::format("TEXTON\n{}\n{}\n{:.8e} {:.8e} {:.8e}\n{} {}\n", format_version, texton.order,
                                 texton.mean[0], texton.mean[1], texton.mean[2], image.width(), image.height());
  for (int y = image.height() - 1; y >= 0; --y) {
    for (int x = 0; x < image.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        const float value = image.at(c, x, y);
        if (!std::isfinite(value)) refuse(fmt::format("coefficient {} at ({}, {})", value, x, y));
        text += fmt::format("{:.8e}{}", value, c < 2 ? ' ' : '\n');
      }
    }
  }
  write_atomically(file, text + texton.source + "\n");
}

}  // namespace textonbench
