// Whole files: read in one go, written completely or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace textonbench {

/// All bytes of a file. Throws std::runtime_error naming it.
std::string read_file(const std::filesystem::path& file);

/// Writes and syncs a file beside `file` and renames it over `file`, so that a crash or a full disk leaves the earlier
/// content. Throws std::runtime_error naming the file.
void write_atomically(const std::filesystem::path& file, std::string_view text);

/// `stem` with `suffix` appended: ("a/b.c", ".svg") gives "a/b.c.svg".
std::filesystem::path with_suffix(const std::filesystem::path& stem, std::string_view suffix);

}  // namespace textonbench
