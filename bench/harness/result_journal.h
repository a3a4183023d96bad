#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace sixdof::bench {

/// A file of JSON objects, one a line, that only grows. A line is on the disk when append() returns, so that whatever
/// ends the program, all lines before stay. The last member of each is "checksum", of the line's text before it and of
/// the line before: a line that was changed, taken out or moved is found.
class ResultJournal {
 public:
  using Json = nlohmann::ordered_json;

  /// Opens the file, makes it if missing, and keeps other processes out of it while this object exists. A last line
  /// that was cut off by a crash is removed.
  /// @throws BadFile if it cannot be opened or written, is a link, has a line that is no JSON or does not have its
  ///   checksum, or is in use by another process
  explicit ResultJournal(std::filesystem::path file);
  ~ResultJournal();
  ResultJournal(const ResultJournal&) = delete;
  ResultJournal& operator=(const ResultJournal&) = delete;

  /// What was in the file when it was opened, without checksums.
  const std::vector<Json>& lines() const { return lines_; }

  /// @param line an object with one member or more
  /// @throws BadFile if the line cannot be written (disk full); the file then has the lines before
  void append(const Json& line);

  /// Removes all lines. @throws BadFile
  void clear();

  void remove();

 private:
  void read();

  std::filesystem::path file_;
  std::vector<Json> lines_;
  std::string last_checksum_;  ///< Of the last line.
  int descriptor_ = -1;
  std::size_t size_ = 0;  ///< Bytes of whole lines.
};

}  // namespace sixdof::bench
