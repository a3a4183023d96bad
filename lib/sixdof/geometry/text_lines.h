#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <sixdof/geometry/load_formats.h>

namespace sixdof::loading {

/// The first byte of a text: behind a UTF-8 byte order mark if there is one.
std::size_t text_begin(std::string_view bytes);

/// Reads the lines of a text file that hold data, as words separated by blanks. Numbers are read by std::from_chars,
/// which no locale changes. Lines end in LF or CR LF; a UTF-8 byte order mark at the file's start is skipped.
class TextLines {
 public:
  struct Syntax {
    char comment = '\0';         ///< Starts a comment that lasts to the end of the line; 0: there are none.
    bool continuation = false;   ///< A backslash at the end of a line joins the next one to it.
    bool newline_at_end = true;  ///< Refuse data on a last line without a line break: it may be cut off.
  };

  /// Starts at byte `begin` of the source, which is on line `line` (from 1).
  TextLines(const Source& source, Syntax syntax, std::size_t begin = 0, std::size_t line = 1);

  /// Advances to the next line that is not blank; false at the end of the file.
  bool next();

  const std::vector<std::string_view>& words() const { return words_; }
  std::size_t size() const { return words_.size(); }

  // Each of these throws a BadFile that names the line if a word is not what it reads.

  /// Word i as a finite number.
  double number(std::size_t i) const;
  /// Words first .. first + 2 as a point.
  Eigen::Vector3d point(std::size_t first) const { return {number(first), number(first + 1), number(first + 2)}; }
  /// A word as a signed integer.
  std::int64_t integer(std::string_view word) const;
  std::int64_t integer(std::size_t i) const { return integer(words_[i]); }
  /// Word i as a vertex index (from 0) below count.
  std::uint32_t index(std::size_t i, std::size_t count) const;

  std::size_t line() const { return line_; }
  std::string place() const;  ///< The current line, for messages: "line 7".
  /// Bytes behind the current line.
  std::size_t remaining() const { return text_.size() - next_; }
  /// Byte behind the current line.
  std::size_t position() const { return next_; }

  [[noreturn]] void fail(const std::string& cause) const;

  /// Fails unless the file ends here.
  void expect_end();

 private:
  bool read_line();

  const Source& source_;
  std::string_view text_;
  Syntax syntax_;
  std::size_t next_;
  std::size_t line_;       // of the first line of words_
  std::size_t next_line_;  // of next_
  std::vector<std::string_view> words_;
};

}  // namespace sixdof::loading
