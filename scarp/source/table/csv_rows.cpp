// SPDX-License-Identifier: MIT
#include "scarp/source/table/csv_rows.h"

#include <fmt/format.h>

#include <algorithm>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

char separator_of(std::string_view text) {
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == ',' || c == ';' || c == '\t') return c;
  }
  return ',';
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

CsvRows::CsvRows(std::string_view text) : text_(text) {
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
  // The first row with a separator is the header, even after blank lines.
  separator_ = separator_of(text_);
}

bool CsvRows::at_line_end() const { return at_ == text_.size() || text_[at_] == '\n' || text_[at_] == '\r'; }

void CsvRows::pass_line_end() {
  if (at_ == text_.size()) return;
  if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
  ++at_;
  ++line_;
}

std::string_view CsvRows::plain_field() {
  const std::size_t begin = at_;
  while (!at_line_end() && text_[at_] != separator_) ++at_;
  return text_.substr(begin, at_ - begin);
}

std::string_view CsvRows::quoted_field() {
  const std::size_t begin = ++at_;
  std::string* unescaped = nullptr;
  for (;; ++at_) {
    if (at_ == text_.size()) throw Error(fmt::format("line {}: unclosed quote", row_line_));
    if (text_[at_] == '"') {
      if (at_ + 1 == text_.size() || text_[at_ + 1] != '"') break;
      // From here on, the field is no longer a substring of the text.
      if (!unescaped) unescaped = &unescaped_.emplace_back(text_.substr(begin, at_ - begin));
      ++at_;
    } else if (text_[at_] == '\n' || (text_[at_] == '\r' && !text_.substr(at_).starts_with("\r\n"))) {
      ++line_;
    }
    if (unescaped) unescaped->push_back(text_[at_]);
  }
  const std::string_view field = unescaped ? std::string_view(*unescaped) : text_.substr(begin, at_ - begin);
  ++at_;
  if (!at_line_end() && text_[at_] != separator_) {
    throw Error(fmt::format("line {}: text after a closing quote (double the quotes inside quoted text)", line_));
  }
  return field;
}

bool CsvRows::next() {
  for (;;) {
    if (at_ == text_.size()) return false;
    fields_.clear();
    unescaped_.clear();
    row_line_ = line_;
    const bool begins_quoted = text_[at_] == '"';
    for (;;) {
      fields_.push_back(at_ < text_.size() && text_[at_] == '"' ? quoted_field() : plain_field());
      if (at_line_end()) break;
      ++at_;
    }
    pass_line_end();
    const bool blank = fields_.size() == 1 && !begins_quoted && trimmed(fields_.front()).empty();
    if (!blank) return true;
  }
}

}  // namespace scarp
