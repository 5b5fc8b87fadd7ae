// SPDX-License-Identifier: MIT
// The rows of a CSV text, one after the other (RFC 4180, with the freedom that files take; see ray_table.h).
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

class CsvRows {
 public:
  /// `text` must outlive the object. The separator is the first of , ; and tab in the first row outside of quotes.
  explicit CsvRows(std::string_view text);

  /// Goes to the next row that is not blank; false at the end. Throws Error, which names the line: quotes that do not
  /// close, or are followed by more text.
  bool next();
  /// Of the row, valid until next().
  const std::vector<std::string_view>& fields() const { return fields_; }
  /// Where the row begins, from 1.
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
  std::deque<std::string> unescaped_;  // fields of the row that had doubled quotes
};

/// `text` without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace scarp
