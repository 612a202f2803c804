// Tables to files that other programs read.
#pragma once

#include <filesystem>
#include <vector>

#include "paper_figures/export_tables.h"

namespace textonbench {

/// <folder>/<table>.csv for every table: RFC 4180 with a line of column names, numbers in full precision, null as an
/// empty field. Returns the paths. Throws std::runtime_error naming a file that cannot be written.
std::vector<std::filesystem::path> write_csv(const std::vector<ExportTable>& tables,
                                             const std::filesystem::path& folder);

/// One SQLite database with all tables and their keys, replacing `file` as a whole. Throws std::runtime_error naming
/// the file when it cannot be written.
void write_sqlite(const std::vector<ExportTable>& tables, const std::filesystem::path& file);

}  // namespace textonbench
