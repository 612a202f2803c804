#include "paper_figures/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "tests/temporary_folder.h"

namespace textonbench::export_test {

using testing::ElementsAre;
using testing::HasSubstr;

Record make_record(const std::string& id, const std::string& exemplar, std::uint64_t seed) {
  return {{"schema", 1},
          {"id", id},
          {"status", "ok"},
          {"spec",
           {{"method", "rpn"},
            {"params", {{"component", "periodic"}, {"order", 3}, {"exact", true}}},
            {"exemplar", exemplar},
            {"exemplar_sha256", "aa"},
            {"size", {0, 0}},
            {"periodic", true},
            {"seed", seed},
            {"samples", 4}}},
          {"command", "textonbench measure rpn 'a, b'"},
          {"exemplar", {{"width", 64}, {"height", 48}, {"channels", 3}}},
          {"metrics",
           {{"rme", {{"value", 1.0 / 3}, {"stderr", nullptr}, {"unit", "1"}, {"floor", 0.125}}},
            {"model_bytes", {{"value", 4096.0}, {"stderr", nullptr}, {"unit", "byte"}, {"floor", nullptr}}}}},
          {"pictures", {{"sample", {{"file", "pictures/00.png"}, {"width", 64}, {"height", 48}}}}},
          {"time",
           {{"wall_seconds", 0.25}, {"cpu_seconds", 0.2}, {"peak_bytes", 1000}, {"finished", "2024-01-02T03:04:05Z"}}},
          {"provenance", {{"version", "0.1.0"}, {"git_dirty", false}, {"cores", 4}, {"libraries", {{"fmt", "9"}}}}}};
}

std::vector<Record> make_records() {
  Record failed = make_record("c", "ring", 3);
  failed["status"] = "failed";
  failed["reason"] = "said \"no\",\nthen died";
  failed["metrics"] = failed["pictures"] = Record::object();
  Record again = make_record("a", "ring", 1);
  again["metrics"]["rme"]["value"] = 0.5;
  return {make_record("a", "ring", 1), make_record("b", "lobe", std::numeric_limits<std::uint64_t>::max()), failed,
          again};
}

class ExportTest : public testing::Test {
 protected:
  /// The result of a query, cells separated by '|', rows by lines; null is "null".
  std::string query(const std::string& sql) const {
    sqlite3* handle = nullptr;
    EXPECT_EQ(sqlite3_open_v2(database().c_str(), &handle, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    std::string text;
    const auto add_row = [](void* out, int count, char** cells, char**) {
      auto& rows = *static_cast<std::string*>(out);
      for (int c = 0; c < count; ++c) rows += std::string(c > 0 ? "|" : "") + (cells[c] != nullptr ? cells[c] : "null");
      rows += "\n";
      return 0;
    };
    char* message = nullptr;
    EXPECT_EQ(sqlite3_exec(handle, sql.c_str(), add_row, &text, &message), SQLITE_OK) << message;
    sqlite3_close(handle);
    return text;
  }
  std::filesystem::path database() const { return folder_.path() / "results.sqlite"; }
  std::string csv(const std::string& table) const {
    std::ifstream in(folder_.path() / "csv" / (table + ".csv"), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  TemporaryFolder folder_;
};

TEST_F(ExportTest, SqliteReadsBack) {
  write_sqlite(make_export_tables(make_records()), database());
  EXPECT_EQ(query("SELECT id, status, exemplar, seed, periodic, exemplar_width FROM runs ORDER BY id"),
            "a|ok|ring|1|1|64\nb|ok|lobe|18446744073709551615|1|64\nc|failed|ring|3|1|64\n");
  EXPECT_EQ(query("SELECT reason FROM runs WHERE status = 'failed'"), "said \"no\",\nthen died\n");
  EXPECT_EQ(query("SELECT run, value, stderr, floor FROM metrics WHERE name = 'rme' AND run = 'a'"),
            "a|0.5|null|0.125\n")
      << "the later record of the same run";
  EXPECT_EQ(query("SELECT value = 1.0 / 3 FROM metrics WHERE name = 'rme' AND run = 'b'"), "1\n");
  EXPECT_EQ(query("SELECT name, value, typeof(value) FROM params WHERE run = 'b' ORDER BY name"),
            "component|periodic|text\nexact|1|integer\norder|3|integer\n");
  EXPECT_EQ(query("SELECT run, file, width FROM pictures ORDER BY run"),
            "a|pictures/00.png|64\nb|pictures/00.png|64\n");
  EXPECT_EQ(query("SELECT count(*), max(cores), max(libraries) FROM provenance"), "1|4|{\"fmt\":\"9\"}\n");
  EXPECT_EQ(query("SELECT count(*) FROM runs JOIN provenance p ON p.id = provenance"), "3\n");
  EXPECT_EQ(query("PRAGMA foreign_key_check"), "");
  EXPECT_EQ(query("PRAGMA integrity_check"), "ok\n");
}

TEST_F(ExportTest, SqliteReplacesTheFileAsAWhole) {
  std::ofstream(database()) << "not a database";
  write_sqlite(make_export_tables(make_records()), database());
  write_sqlite(make_export_tables({make_record("z", "ring", 1)}), database());
  EXPECT_EQ(query("SELECT id FROM runs"), "z\n");
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path(), database()) << "a draft was left";
  }
}

TEST_F(ExportTest, AFileThatCannotBeWrittenIsNamed) {
  try {
    write_sqlite(make_export_tables(make_records()), folder_.path() / "nowhere" / "results.sqlite");
    FAIL() << "written";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("nowhere/results.sqlite: cannot be written"));
  }
  std::ofstream(folder_.path() / "file") << "";
  EXPECT_THROW(write_csv(make_export_tables(make_records()), folder_.path() / "file" / "csv"), std::runtime_error);
}

TEST_F(ExportTest, CsvReadsBack) {
  const auto files = write_csv(make_export_tables(make_records()), folder_.path() / "csv");
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) names.push_back(file.filename());
  EXPECT_THAT(names, ElementsAre("provenance.csv", "runs.csv", "metrics.csv", "params.csv", "pictures.csv"));
  EXPECT_EQ(csv("metrics"),
            "run,name,value,stderr,unit,floor\r\n"
            "a,rme,0.5,,1,0.125\r\na,model_bytes,4096.0,,byte,\r\n"
            "b,rme,0.3333333333333333,,1,0.125\r\nb,model_bytes,4096.0,,byte,\r\n");
  EXPECT_EQ(csv("pictures"),
            "run,name,file,width,height\r\na,sample,pictures/00.png,64,48\r\n"
            "b,sample,pictures/00.png,64,48\r\n");
  EXPECT_THAT(csv("runs"), HasSubstr("\r\nb,ok,,rpn,lobe,aa,64,48,3,0,0,1,18446744073709551615,4,"
                                     "\"textonbench measure rpn 'a, b'\",0.25,0.2,1000,2024-01-02T03:04:05Z,"));
  EXPECT_THAT(csv("runs"), HasSubstr("\r\nc,failed,\"said \"\"no\"\",\nthen died\",rpn,ring,"));
}

}  // namespace textonbench::export_test
