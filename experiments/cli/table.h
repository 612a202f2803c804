// Aligned text tables for people.
#pragma once

#include <string>
#include <vector>

namespace textonbench::cli {

enum class Align { left, right };

struct Column {
  std::string title;
  Align align = Align::left;
};

/// Prints to standard output: a line of titles, then the rows, two spaces between columns. Widths count UTF-8 code
/// points.
void print_table(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows);

}  // namespace textonbench::cli
