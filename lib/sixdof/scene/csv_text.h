#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sixdof::scene {

/// A table as text, as spreadsheets, scripts and people write it: UTF-8, with or without a byte order mark; lines end
/// in LF, CR LF or CR. Cells are separated by commas, semicolons or tabs, of which the first line must have one kind
/// only; blanks around a cell do not count; a cell in double quotes may have separators, and two quotes for one.
/// Skipped are empty lines, those that begin with #, those of separators alone, and a first line `sep=;`.
class CsvText {
 public:
  struct Row {
    std::size_t line = 0;  ///< From 1.
    std::vector<std::string> cells;
  };

  /// @throws BadFile if the file cannot be read, or is text in UTF-16
  explicit CsvText(std::filesystem::path file);

  /// Reads the next row. @returns false at the end
  /// @throws BadFile "FILE: line N: CAUSE": two kinds of separators in the first row, a quote that does not end in its
  /// line or has text behind it, a byte 0
  bool next(Row& row);

 private:
  [[noreturn]] void refuse(const std::string& cause) const;
  std::string_view next_line();
  void find_separator(std::string_view line);
  void split(std::string_view line, std::vector<std::string>& cells) const;

  std::filesystem::path file_;
  std::string text_;
  std::string_view rest_;
  std::size_t line_ = 0;
  char separator_ = '\0';  ///< Of cells; 0 before the first row.
};

}  // namespace sixdof::scene
