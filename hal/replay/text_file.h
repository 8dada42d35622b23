#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/error.h"

namespace lumibox::hal {

/// One line of fields separated by white space. Valid while its TextFile lives.
class TextLine {
 public:
  TextLine(const std::filesystem::path& file, int line, std::string_view text);

  int line() const { return line_; }  ///< from 1
  int count() const { return static_cast<int>(fields_.size()); }

  /// Finite number in a column (from 0); throws if there is none.
  double number(std::size_t column) const;
  int integer(std::size_t column) const;

  /// The text after the first field, without the white space around it.
  std::string rest_after_first() const;

  /// Throws unless there are min to max fields; `expected` names them.
  void expect_count(int min, int max, const std::string& expected) const;

  /// The text of a column for an error message, cut to a readable length.
  std::string quoted(std::size_t column) const;

  /// An error that names file and line, to be thrown by the caller.
  config::InputError error(const std::string& message) const;

 private:
  const std::filesystem::path* file_;
  int line_;
  std::string_view text_;
  std::vector<std::string_view> fields_;
};

/// The lines of a text file that are neither empty nor begin with '#'.
class TextFile {
 public:
  /// Throws config::InputError if the file cannot be read.
  explicit TextFile(const std::filesystem::path& file);
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  const std::vector<TextLine>& lines() const { return lines_; }

 private:
  std::filesystem::path file_;
  std::string text_;
  std::vector<TextLine> lines_;
};

}  // namespace lumibox::hal
