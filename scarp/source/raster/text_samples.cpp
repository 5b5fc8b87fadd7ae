// SPDX-License-Identifier: MIT
#include "scarp/source/raster/text_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/raster/vsi_file.h"

namespace scarp {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
// Longer words are not numbers; longer lines are not headers.
constexpr std::size_t kLongestWord = 512;
constexpr std::size_t kShownBytes = 24;

// Kinds of bytes, as a set of bits.
enum : unsigned { kSpace = 1, kDigit = 2, kSign = 4, kFraction = 8, kOther = 16 };

constexpr std::array<std::uint8_t, 256> kinds_of_bytes() {
  std::array<std::uint8_t, 256> kinds{};
  kinds.fill(kOther);
  // Zeros and Ctrl-Z pad the ends of old files.
  for (const char c : {' ', '\t', '\n', '\v', '\f', '\r', '\0', '\x1a'}) kinds[static_cast<unsigned char>(c)] = kSpace;
  for (char c = '0'; c <= '9'; ++c) kinds[static_cast<unsigned char>(c)] = kDigit;
  for (const char c : {'+', '-'}) kinds[static_cast<unsigned char>(c)] = kSign;
  // Some countries write decimal commas.
  for (const char c : {'.', ',', 'e', 'E'}) kinds[static_cast<unsigned char>(c)] = kFraction;
  return kinds;
}
constexpr std::array<std::uint8_t, 256> kKinds = kinds_of_bytes();

unsigned kind_of(char c) { return kKinds[static_cast<unsigned char>(c)]; }

// NaN and infinity, as C libraries print them: nan, -nan(ind), inf, Infinity, 1.#QNAN, -1.#IND, 1.#INF.
bool is_special_number(std::string_view word) {
  const std::string text = lower_case(std::string(word.substr(word.starts_with('-') || word.starts_with('+'))));
  return text.starts_with("nan") || text == "inf" || text == "infinity" || text.starts_with("1.#");
}

std::size_t words_in(std::string_view line) {
  std::size_t words = 0;
  bool in_word = false;
  for (const char c : line) {
    const bool space = kind_of(c) == kSpace;
    words += !space && !in_word;
    in_word = !space;
  }
  return words;
}

// Whether a line is part of the header: a name with a value, or all of them on one line.
bool is_header_line(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return true;
  const std::string_view text = line.substr(begin), first = text.substr(0, text.find_first_of(" \t"));
  if (!std::isalpha(static_cast<unsigned char>(first.front())) || is_special_number(first)) return false;
  return words_in(text) == 2 || lower_case(std::string(first)) == "ncols";
}

std::string shown(std::string_view word) {
  std::string text(word.substr(0, kShownBytes));
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c))) c = '?';
  }
  return text + (word.size() > kShownBytes ? "..." : "");
}

}  // namespace

void TextSamples::take(std::string_view bytes) {
  if (left_ <= 0) return;
  rest_ += bytes;
  std::string_view text = without_header(rest_);
  // The last word may continue in the next piece.
  std::size_t end = text.size();
  while (!in_header_ && end > 0 && kind_of(text[end - 1]) != kSpace) --end;
  if (in_header_) end = 0;
  if (text.size() - end > kLongestWord) end = text.size();
  take_words(text.substr(0, end));
  rest_ = std::string(text.substr(end));
}

void TextSamples::end() {
  in_header_ = false;
  const std::string last = std::move(rest_);
  take_words(last);
}

std::string_view TextSamples::without_header(std::string_view text) {
  while (in_header_) {
    const std::size_t end = text.find_first_of("\r\n");
    if (end == std::string_view::npos) {
      in_header_ = text.size() <= kLongestWord;
      break;
    }
    in_header_ = is_header_line(text.substr(0, end));
    if (!in_header_) break;
    line_ += text[end] == '\n';
    text.remove_prefix(end + 1);
  }
  return text;
}

void TextSamples::take_words(std::string_view text) {
  const char* p = text.data();
  const char* const end = p + text.size();
  while (left_ > 0) {
    for (; p < end && kind_of(*p) == kSpace; ++p) line_ += *p == '\n';
    if (p == end) return;
    const char* const begin = p;
    unsigned kinds = 0;
    for (unsigned kind; p < end && (kind = kind_of(*p)) != kSpace; ++p) kinds |= kind;
    left_ -= 1;
    if (kinds != kDigit) judge({begin, p}, kinds);
  }
}

void TextSamples::judge(std::string_view word, unsigned kinds) {
  const bool digits = (kinds & kDigit) != 0 && (kinds & kOther) == 0;
  if (!digits && !is_special_number(word)) {
    throw Error(fmt::format("line {}: '{}' is not a number (write the NODATA_value where there is no height)", line_,
                            shown(word)));
  }
  if ((kinds & (kFraction | kOther)) != 0) integers_ = false;
}

bool has_integers_alone(const std::string& path, double count) {
  const VsiFile file(VSIFOpenL(path.c_str(), "rb"));
  if (!file) throw Error("cannot be opened (no read permission?)");
  TextSamples samples(count);
  std::string piece(kPieceBytes, '\0');
  while (const std::size_t bytes = VSIFReadL(piece.data(), 1, piece.size(), file.get()))
    samples.take(std::string_view(piece).substr(0, bytes));
  samples.end();
  return samples.integers();
}

}  // namespace scarp
