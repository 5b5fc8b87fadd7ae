// SPDX-License-Identifier: MIT
// Iterates over the rows of a CSV text (RFC 4180 with common deviations; see ray_table.h).
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

class CsvRows {
 public:
  /// `text` must outlive the object. The separator is the first comma, semicolon or tab outside quotes in the first
  /// row.
  explicit CsvRows(std::string_view text);

  /// Moves to the next row that is not blank; returns false at the end. Throws Error naming the line for unclosed
  /// quotes, or quotes followed by text.
  bool next();
  /// Fields of the row, valid until next().
  const std::vector<std::string_view>& fields() const { return fields_; }
  /// Number of the row's first line, from 1.
  std::int64_t line() const { return row_line_; }

 private:
  bool at_line_end() const;
  void pass_line_end();
  std::string_view quoted_field();
  std::string_view plain_field();

  std::string_view text_;
  std::size_t at_ = 0;
  char separator_ = ',';
  std::int64_t line_ = 1;
  std::int64_t row_line_ = 0;
  std::vector<std::string_view> fields_;
  std::deque<std::string> unescaped_;  // fields of the row that contained doubled quotes
};

/// Returns `text` without leading and trailing blanks and tabs.
std::string_view trimmed(std::string_view text);

}  // namespace scarp
