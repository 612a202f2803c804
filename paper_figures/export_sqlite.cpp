#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sqlite3.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>

#include "paper_figures/export.h"

namespace textonbench {
namespace {

class Database {
 public:
  explicit Database(const std::filesystem::path& file) {
    sqlite3* handle = nullptr;
    const int status = sqlite3_open(file.c_str(), &handle);
    handle_.reset(handle);
    require(status == SQLITE_OK);
  }

  void execute(const std::string& sql) {
    require(sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  }

  void insert(const ExportTable& table) {
    const std::string sql = fmt::format("INSERT INTO {} VALUES ({})", table.name,
                                        fmt::join(std::vector<std::string_view>(table.columns.size(), "?"), ", "));
    sqlite3_stmt* prepared = nullptr;
    require(sqlite3_prepare_v2(handle_.get(), sql.c_str(), -1, &prepared, nullptr) == SQLITE_OK);
    const std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)> statement(prepared, &sqlite3_finalize);
    for (const std::vector<Record>& row : table.rows) {
      for (std::size_t c = 0; c < row.size(); ++c) bind(prepared, static_cast<int>(c) + 1, row[c]);
      require(sqlite3_step(prepared) == SQLITE_DONE);
      require(sqlite3_reset(prepared) == SQLITE_OK);
    }
  }

 private:
  void require(bool success) {
    if (!success) throw std::runtime_error(sqlite3_errmsg(handle_.get()));
  }

  void bind(sqlite3_stmt* statement, int place, const Record& value) {
    if (value.is_null()) {
      require(sqlite3_bind_null(statement, place) == SQLITE_OK);
    } else if (value.is_number_integer()) {
      require(sqlite3_bind_int64(statement, place, value.get<std::int64_t>()) == SQLITE_OK);
    } else if (value.is_number()) {
      require(sqlite3_bind_double(statement, place, value.get<double>()) == SQLITE_OK);
    } else {
      const auto& text = value.get_ref<const std::string&>();
      require(sqlite3_bind_text(statement, place, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT) ==
              SQLITE_OK);
    }
  }

  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> handle_{nullptr, &sqlite3_close};
};

std::string create_table(const ExportTable& table) {
  std::vector<std::string> parts;
  for (const ExportColumn& column : table.columns)
    parts.push_back(fmt::format("{} {}", column.name, column.definition));
  if (!table.constraint.empty()) parts.emplace_back(table.constraint);
  return fmt::format("CREATE TABLE {} ({})", table.name, fmt::join(parts, ", "));
}

void fill(const std::filesystem::path& file, const std::vector<ExportTable>& tables) {
  Database database(file);
  database.execute("PRAGMA foreign_keys = ON");
  database.execute("BEGIN");
  for (const ExportTable& table : tables) {
    database.execute(create_table(table));
    database.insert(table);
  }
  database.execute("COMMIT");
}

}  // namespace

void write_sqlite(const std::vector<ExportTable>& tables, const std::filesystem::path& file) {
  const std::filesystem::path draft = file.parent_path() / fmt::format(".{}.{}", file.filename().string(), ::getpid());
  std::error_code ignored;
  std::filesystem::remove(draft, ignored);
  try {
    fill(draft, tables);
    std::filesystem::rename(draft, file);
  } catch (const std::exception& error) {
    std::filesystem::remove(draft, ignored);
    std::filesystem::remove(draft.string() + "-journal", ignored);
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), error.what()));
  }
}

}  // namespace textonbench
