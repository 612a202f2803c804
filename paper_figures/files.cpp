#include "paper_figures/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace textonbench {

std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(fmt::format("{}: cannot be read", file.string()));
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const std::filesystem::path& file, std::string_view bytes) {
  const std::filesystem::path draft = with_suffix(file, fmt::format(".draft_{}", ::getpid()));
  std::error_code error;
  {
    std::ofstream stream(draft, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) std::filesystem::rename(draft, file, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(draft, ignored);
    throw std::runtime_error(fmt::format("{}: cannot be written (is the disk full?)", file.string()));
  }
}

std::filesystem::path with_suffix(const std::filesystem::path& stem, std::string_view suffix) {
  std::filesystem::path path = stem;
  return path += suffix;
}

}  // namespace textonbench
