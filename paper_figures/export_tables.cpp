#include "paper_figures/export_tables.h"

#include <set>

#include "experiments/provenance.h"

namespace textonbench {
namespace {

/// The value under `key`, as a cell; null where there is none.
Record cell(const Record& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  if (found == object.end()) return nullptr;
  if (found->is_boolean()) return found->get<bool>() ? 1 : 0;
  return found->is_structured() ? Record(found->dump()) : *found;
}

Record member(const Record& object, std::string_view key) {
  const auto found = object.find(key);
  return found == object.end() ? Record(nullptr) : *found;
}

std::vector<Record> cells(const Record& object, const std::vector<ExportColumn>& columns, std::size_t first) {
  std::vector<Record> row;
  for (std::size_t c = first; c < columns.size(); ++c) row.push_back(cell(object, columns[c].name));
  return row;
}

ExportTable provenance_table() {
  return {"provenance",
          {{"id", "TEXT PRIMARY KEY"},
           {"version", "TEXT"},
           {"code_version", "TEXT"},
           {"git_commit", "TEXT"},
           {"git_dirty", ""},
           {"compiler", "TEXT"},
           {"flags", "TEXT"},
           {"build_type", "TEXT"},
           {"cpu", "TEXT"},
           {"cores", "INTEGER"},
           {"threads", "INTEGER"},
           {"os", "TEXT"},
           {"libraries", "TEXT"},
           {"fft_plans", "TEXT"}},
          ""};
}

ExportTable runs_table() {
  return {"runs",
          {{"id", "TEXT PRIMARY KEY"},
           {"status", "TEXT NOT NULL"},
           {"reason", "TEXT"},
           {"method", "TEXT"},
           {"exemplar", "TEXT"},
           {"exemplar_sha256", "TEXT"},
           {"exemplar_width", "INTEGER"},
           {"exemplar_height", "INTEGER"},
           {"exemplar_channels", "INTEGER"},
           {"width", "INTEGER"},
           {"height", "INTEGER"},
           {"periodic", "INTEGER"},
           // Up to 2^64 - 1, which SQLite's integers do not reach.
           {"seed", "TEXT"},
           {"samples", "INTEGER"},
           {"command", "TEXT"},
           {"wall_seconds", "REAL"},
           {"cpu_seconds", "REAL"},
           {"peak_bytes", "INTEGER"},
           {"finished", "TEXT"},
           {"provenance", "TEXT REFERENCES provenance(id)"}},
          ""};
}

ExportTable metrics_table() {
  return {"metrics",
          {{"run", "TEXT NOT NULL REFERENCES runs(id)"},
           {"name", "TEXT NOT NULL"},
           {"value", "REAL"},
           {"stderr", "REAL"},
           {"unit", "TEXT"},
           {"floor", "REAL"}},
          "PRIMARY KEY (run, name)"};
}

ExportTable params_table() {
  return {"params",
          {{"run", "TEXT NOT NULL REFERENCES runs(id)"}, {"name", "TEXT NOT NULL"}, {"value", ""}},
          "PRIMARY KEY (run, name)"};
}

ExportTable pictures_table() {
  return {"pictures",
          {{"run", "TEXT NOT NULL REFERENCES runs(id)"},
           {"name", "TEXT NOT NULL"},
           {"file", "TEXT"},
           {"width", "INTEGER"},
           {"height", "INTEGER"}},
          "PRIMARY KEY (run, name)"};
}

std::vector<Record> run_row(const Record& record, const std::string& provenance_id) {
  const Record spec = member(record, "spec"), exemplar = member(record, "exemplar"), time = member(record, "time");
  const Record seed = cell(spec, "seed");
  Record size = member(spec, "size");
  if (!size.is_array() || size.size() != 2) size = {nullptr, nullptr};
  return {record["id"],
          record["status"],
          cell(record, "reason"),
          cell(spec, "method"),
          cell(spec, "exemplar"),
          cell(spec, "exemplar_sha256"),
          cell(exemplar, "width"),
          cell(exemplar, "height"),
          cell(exemplar, "channels"),
          size[0],
          size[1],
          cell(spec, "periodic"),
          seed.is_null() ? seed : Record(seed.dump()),
          cell(spec, "samples"),
          cell(record, "command"),
          cell(time, "wall_seconds"),
          cell(time, "cpu_seconds"),
          cell(time, "peak_bytes"),
          cell(time, "finished"),
          provenance_id};
}

/// Rows (run, name, …) of an object of objects.
void add_named(ExportTable& table, const Record& id, const Record& named) {
  if (!named.is_object()) return;
  for (const auto& [name, object] : named.items()) {
    std::vector<Record> row{id, name};
    for (Record& value : cells(object, table.columns, 2)) row.push_back(std::move(value));
    table.rows.push_back(std::move(row));
  }
}

std::vector<Record> latest_records(const std::vector<Record>& records) {
  std::vector<std::string> ids;
  std::set<std::string> known;
  for (const Record& record : records) {
    const std::string id = record["id"];
    if (known.insert(id).second) ids.push_back(id);
  }
  std::vector<Record> latest;
  for (std::optional<Record>& record : latest_by_id(records, ids)) latest.push_back(*std::move(record));
  return latest;
}

}  // namespace

std::vector<ExportTable> make_export_tables(const std::vector<Record>& records) {
  ExportTable provenance = provenance_table(), runs = runs_table(), metrics = metrics_table(), params = params_table(),
              pictures = pictures_table();
  std::set<std::string> known;
  for (const Record& record : latest_records(records)) {
    const Record origin = member(record, "provenance");
    const std::string origin_id = sha256(origin.dump()).substr(0, 16);
    if (known.insert(origin_id).second) {
      std::vector<Record> row{origin_id};
      for (Record& value : cells(origin, provenance.columns, 1)) row.push_back(std::move(value));
      provenance.rows.push_back(std::move(row));
    }
    const Record& id = record["id"];
    runs.rows.push_back(run_row(record, origin_id));
    add_named(metrics, id, member(record, "metrics"));
    add_named(pictures, id, member(record, "pictures"));
    const Record given = member(member(record, "spec"), "params");
    if (!given.is_object()) continue;
    for (const auto& [name, value] : given.items()) params.rows.push_back({id, name, cell(given, name)});
  }
  return {provenance, runs, metrics, params, pictures};
}

}  // namespace textonbench
