// Whole files in one go.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace textonbench {

/// All bytes of a file. Throws std::runtime_error naming it.
std::string read_file(const std::filesystem::path& file);

/// Writes the bytes beside the file, then renames: complete or not at all. Throws std::runtime_error naming the file.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// `stem` with `suffix` appended: ("a/b.c", ".svg") gives "a/b.c.svg".
std::filesystem::path with_suffix(const std::filesystem::path& stem, std::string_view suffix);

}  // namespace textonbench
