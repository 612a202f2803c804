#include <fmt/format.h>

#include <stdexcept>
#include <system_error>

#include "experiments/files.h"
#include "paper_figures/export.h"
#include "paper_figures/table.h"

namespace textonbench {

std::vector<std::filesystem::path> write_csv(const std::vector<ExportTable>& tables,
                                             const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot be created: {}", folder.string(), error.message()));
  std::vector<std::filesystem::path> files;
  for (const ExportTable& table : tables) {
    std::string text;
    for (const ExportColumn& column : table.columns) {
      text += fmt::format("{}{}", &column == table.columns.data() ? "" : ",", column.name);
    }
    text += "\r\n";
    for (const std::vector<Record>& row : table.rows) {
      for (const Record& value : row) {
        if (&value != row.data()) text += ",";
        if (!value.is_null()) text += value.is_string() ? csv_field(value.get<std::string>()) : value.dump();
      }
      text += "\r\n";
    }
    files.push_back(folder / fmt::format("{}.csv", table.name));
    write_atomically(files.back(), text);
  }
  return files;
}

}  // namespace textonbench
