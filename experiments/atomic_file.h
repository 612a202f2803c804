// Files that are there as a whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace textonbench {

/// Writes and syncs a file beside `file` and renames it over `file`, so that a crash or a full disk leaves the earlier
/// content. Throws std::runtime_error naming the file.
void write_atomically(const std::filesystem::path& file, std::string_view text);

}  // namespace textonbench
