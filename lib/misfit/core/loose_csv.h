#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace misfit {

/// A column as a foreign program wrote it.
struct LooseColumn {
  std::string header;          ///< as in the file
  std::vector<double> values;  ///< NaN where empty, "nan", "NA" or "null", or where `text` counts
  std::size_t text = 0;        ///< cells that are no number
  int text_line = 0;           ///< line of the first of them
  std::string first_text;
  bool dates = false;  ///< dates and times of day: values are seconds since `first_date`, or since the midnight before it
  std::string first_date;
  bool from_midnight = false;  ///< where they last for three days and more, so that a time of day is that of the clock
};

struct LooseTable {
  std::string source;
  char delimiter = ',';        ///< ',', ';', '\t' or ' ' (blanks)
  bool decimal_comma = false;  ///< "1,5" is one and a half
  std::size_t comments = 0;    ///< lines that begin with '#' or '%'
  std::vector<int> line;       ///< of each row
  std::vector<LooseColumn> columns;

  [[nodiscard]] std::size_t rows() const { return line.size(); }
};

/// Reads numbers in columns however they are separated: by commas, semicolons, tabs or blanks, found from the lines themselves; with a
/// decimal point, or a decimal comma where the separator is another, found from the first row that shows it. The header may be the last
/// comment line; `names`, if there are any, replace it where the file has none, and else instead of its own. Quotation marks around cells
/// are taken off. A column of dates (core/iso_date.h) is read as seconds. InputError: other than as many names as columns; no such file,
/// nothing in it, no header ("the first line holds numbers"), no rows, rows of another length, one column alone, a name used twice.
[[nodiscard]] LooseTable read_loose_csv(const std::filesystem::path& path, const std::vector<std::string>& names = {});

}  // namespace misfit
