// Records as flat tables, for people who query.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/record.h"

namespace textonbench {

struct ExportColumn {
  std::string_view name;
  std::string_view definition;  ///< type and constraints in SQL
};

/// Cells are null, numbers or text; truth values are 0 and 1.
struct ExportTable {
  std::string_view name;
  std::vector<ExportColumn> columns;
  std::string_view constraint;  ///< of the table in SQL, may be empty
  std::vector<std::vector<Record>> rows{};
};

/// provenance (one row each distinct one), runs (one row an id: its last record that did not fail, or its last), and,
/// by run: metrics, params, pictures. A table refers to earlier ones only.
std::vector<ExportTable> make_export_tables(const std::vector<Record>& records);

}  // namespace textonbench
