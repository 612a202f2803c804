// Experiment configs: TOML in, typed values out. Every error says file:line:column and what was expected.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "methods/base/image.h"
#include "methods/base/params.h"

namespace textonbench {

enum class Profile { quick, full };

/// How the lists of a [[runs]] table make its runs.
enum class Combine {
  grid,   ///< every combination
  zip,    ///< all lists longer than one advance together
  ablate  ///< of the parameters, the first values, then one parameter at a time at its others; the rest as a grid
};

/// Where a value stands in its file: "configs/x.toml:12:5".
struct SourcePlace {
  std::string file;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
};

/// what() is "file:line:column: message".
class ConfigError : public std::invalid_argument {
 public:
  ConfigError(const SourcePlace& place, const std::string& message);
};

/// One [[runs]] table after [defaults] and the profile's overrides: every axis is a list, a scalar being a list of one.
struct RunsTable {
  SourcePlace place;
  std::string label;
  Combine combine = Combine::grid;
  std::vector<std::string> methods;
  std::vector<std::string> exemplars;  ///< names; "@tag" stands for every exemplar with that tag
  std::vector<std::uint64_t> seeds{1};
  std::vector<Extent> sizes{Extent{}};
  std::vector<bool> periodic{true};
  double step = 1;  ///< between pixels of a sample; at another one only models are measured
  int samples = 1;
  double timeout_seconds = 300;
  int memory_limit_mb = 0;  ///< of each run; 0: a share of the machine's memory
  std::vector<std::string> metrics;
  std::vector<std::string> pictures;
  std::map<std::string, std::vector<ParamValue>> params;
  std::map<std::string, std::vector<ParamValue>> gpu;      ///< of samples drawn there (gpu_run.h), else empty
  std::vector<std::map<std::string, ParamValue>> exclude;  ///< keys: method, exemplar, seed, or a parameter's name
  std::map<std::string, SourcePlace> places;               ///< of each key, for errors found later
};

/// A column of a picture panel or of a table, an axis of a chart, …: free-form keys that the figure kind checks.
struct FigureTable {
  SourcePlace place;
  std::string name, kind, title, caption;
  std::vector<std::string> runs;  ///< labels of the [[runs]] tables it reads
  std::map<std::string, ParamValue> options;
  std::map<std::string, std::vector<std::map<std::string, ParamValue>>> lists;  ///< arrays of tables: columns, …
  std::map<std::string, std::vector<ParamValue>> arrays;                        ///< plain arrays
  std::map<std::string, SourcePlace> places;
};

struct Config {
  std::string name;  ///< path below configs/ without extension: "lectures2022/rpn_adsn"
  std::filesystem::path file;
  std::string title, source, description;
  bool appendix = false;  ///< evidence: the report shows it after the configs that are not
  std::vector<RunsTable> runs;
  std::vector<FigureTable> figures;
};

/// Throws ConfigError, or std::invalid_argument naming a file that cannot be read.
Config read_config(const std::filesystem::path& file, Profile profile);

}  // namespace textonbench
