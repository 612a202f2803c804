// What a kind of figure must be able to do. The list of kinds is in catalog.cpp.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "paper_figures/picture_store.h"
#include "paper_figures/selection.h"

namespace textonbench {

/// What a figure is made from.
struct FigureInput {
  const FigureTable& table;
  const std::vector<SelectedRun>& runs;  ///< of the figure's [[runs]] tables; each has a record once `check` is past
  std::string anchor;                    ///< id of the figure in the report; ids inside the figure start with it
};

struct FigureKind {
  std::string_view name;
  /// Throws ConfigError when the table has unknown or missing keys, or asks for what its planned runs cannot give.
  /// Records are not needed.
  void (*check)(const FigureInput&);
  /// Writes the figure's files, named `stem` with an extension, and returns them. `results` is where pictures lie.
  std::vector<std::filesystem::path> (*write)(const FigureInput&, const ResultsFolder& results,
                                              const std::filesystem::path& stem);
  /// The figure as a piece of the report, where "#r-<id>" leads to a record. `write` has run before.
  std::string (*html)(const FigureInput&, PictureStore& pictures, const std::filesystem::path& stem);
};

std::span<const FigureKind> figure_catalog();
/// Throws ConfigError at the table's `kind`, naming the nearest known kind.
const FigureKind& find_figure_kind(const FigureTable& table);

/// Place of a key in the config file, of the figure itself when the key is absent.
const SourcePlace& place_of(const FigureTable& table, const std::string& key);

/// Throws ConfigError for any scalar option, array of tables or plain array of the figure that is not among these.
void require_known_keys(const FigureTable& table, std::initializer_list<std::string_view> options,
                        std::initializer_list<std::string_view> lists, std::initializer_list<std::string_view> arrays);

/// Throws ConfigError unless every table of lists[list] has all `required` keys and no other than these and `optional`.
void require_known_columns(const FigureTable& table, const std::string& list,
                           std::span<const std::string_view> required, std::span<const std::string_view> optional);

}  // namespace textonbench
