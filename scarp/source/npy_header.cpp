// SPDX-License-Identifier: MIT
#include "scarp/source/npy_header.h"

#include <fmt/format.h>

#include <limits>

#include "scarp/base/error.h"

namespace scarp {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";
constexpr const char* kNested =
    "has a field that is an array or a structure itself; fields of plain numbers are needed";
constexpr int kLargestStructure = 1 << 20;  // bytes; sums of field sizes stay far below overflow

[[noreturn]] void refuse(const std::string& what) {
  throw Error(fmt::format("damaged .npy header: {} (save the array again with numpy.save)", what));
}

// Reads the dictionary, a Python literal, from left to right.
class Literal {
 public:
  explicit Literal(std::string_view text) : text_(text) {}

  bool take(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!take(c)) refuse(fmt::format("expected '{}' at byte {} of the dictionary", c, at_));
  }
  bool looking_at(char c) {
    skip_blanks();
    return at_ < text_.size() && text_[at_] == c;
  }
  std::string quoted() {
    skip_blanks();
    if (at_ >= text_.size() || (text_[at_] != '\'' && text_[at_] != '"')) refuse("expected a quoted text");
    const char quote = text_[at_++];
    const std::size_t end = text_.find(quote, at_);
    if (end == std::string_view::npos) refuse("unclosed quote");
    const std::string value(text_.substr(at_, end - at_));
    at_ = end + 1;
    return value;
  }
  bool boolean() {
    skip_blanks();
    for (const std::string_view word : {"True", "False"}) {
      if (text_.substr(at_, word.size()) == word) {
        at_ += word.size();
        return word == "True";
      }
    }
    refuse("expected True or False for 'fortran_order'");
  }
  std::int64_t integer() {
    skip_blanks();
    const std::size_t begin = at_;
    std::int64_t value = 0;
    for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_) {
      if (value > (std::numeric_limits<std::int64_t>::max() - 9) / 10) refuse("an extent exceeds 64 bits");
      value = value * 10 + (text_[at_] - '0');
    }
    if (at_ == begin) refuse("expected an integer >= 0 in 'shape'");
    // Python 2 wrote long integers with an L.
    if (at_ < text_.size() && text_[at_] == 'L') ++at_;
    return value;
  }
  void end() {
    skip_blanks();
    if (at_ != text_.size()) refuse("text after the dictionary");
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
      ++at_;
  }
  std::string_view text_;
  std::size_t at_ = 0;
};

// Type is NpyHeader or NpyField: both have kind, bytes and big_endian.
template <class Type>
void parse_descr(std::string_view descr, Type& header) {
  std::size_t at = 0;
  if (!descr.empty() && std::string_view("<>|=").find(descr[0]) != std::string_view::npos) {
    // '=' is the machine's own byte order; NumPy never writes it, because files have a fixed order.
    if (descr[0] == '=') refuse(fmt::format("sample type '{}' without a byte order", descr));
    header.big_endian = descr[0] == '>';
    at = 1;
  }
  if (at == descr.size()) refuse(fmt::format("unknown sample type '{}'", descr));
  header.kind = descr[at++];
  header.bytes = 0;
  for (; at < descr.size() && descr[at] >= '0' && descr[at] <= '9' && header.bytes < 1000; ++at)
    header.bytes = header.bytes * 10 + (descr[at] - '0');
}

// A list of pairs: [('x', '<f8'), ('y', '<f8')].
void parse_structure(Literal& literal, NpyHeader& header) {
  header.kind = 'V';
  header.bytes = 0;
  literal.expect('[');
  while (!literal.take(']')) {
    NpyField& field = header.fields.emplace_back();
    literal.expect('(');
    if (literal.looking_at('(')) throw Error("field with a title (use plain field names)");
    field.name = literal.quoted();
    literal.expect(',');
    if (literal.looking_at('[')) throw Error(kNested);
    parse_descr(literal.quoted(), field);
    if (literal.take(',') && !literal.looking_at(')')) throw Error(kNested);
    literal.expect(')');
    // NumPy states the length of a text in characters, which have four bytes each.
    field.begin = header.bytes;
    header.bytes += field.kind == 'U' ? 4 * field.bytes : field.bytes;
    if (header.bytes > kLargestStructure) refuse(fmt::format("structure of more than {} bytes", kLargestStructure));
    if (!literal.take(',')) {
      literal.expect(']');
      break;
    }
  }
  if (header.fields.empty()) refuse("structure without fields");
}

std::uint32_t byte(std::string_view bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

NpyHeader parse(std::string_view bytes, bool structures) {
  NpyHeader header;
  header.data_begin = npy_data_begin(bytes);
  if (static_cast<std::int64_t>(bytes.size()) < header.data_begin) refuse("truncated");
  const std::size_t begin = byte(bytes, 6) == 1 ? 10 : 12;
  Literal literal(bytes.substr(begin, static_cast<std::size_t>(header.data_begin) - begin));
  bool has_descr = false, has_order = false, has_shape = false;
  literal.expect('{');
  while (!literal.take('}')) {
    const std::string key = literal.quoted();
    literal.expect(':');
    if (key == "descr") {
      if (structures && literal.looking_at('[')) {
        parse_structure(literal, header);
      } else if (literal.looking_at('[') || literal.looking_at('{') || literal.looking_at('(')) {
        throw Error("array of structures instead of plain numbers (save one of its fields)");
      } else {
        header.descr = literal.quoted();
        parse_descr(header.descr, header);
      }
      has_descr = true;
    } else if (key == "fortran_order") {
      header.fortran_order = literal.boolean();
      has_order = true;
    } else if (key == "shape") {
      header.shape.clear();
      literal.expect('(');
      while (!literal.take(')')) {
        header.shape.push_back(literal.integer());
        if (!literal.take(',')) {
          literal.expect(')');
          break;
        }
      }
      has_shape = true;
    } else {
      refuse(fmt::format("unknown entry '{}'", key));
    }
    if (!literal.take(',')) {
      literal.expect('}');
      break;
    }
  }
  literal.end();
  if (!has_descr || !has_order || !has_shape) refuse("'descr', 'fortran_order' and 'shape' are required");
  return header;
}

}  // namespace

std::int64_t npy_data_begin(std::string_view preamble) {
  if (preamble.substr(0, kNpyMagic.size()) != kNpyMagic)
    throw Error("not a .npy array: does not begin with \\x93NUMPY");
  if (preamble.size() < kNpyPreambleBytes) refuse("truncated");
  const std::uint32_t major = byte(preamble, 6);
  if (major < 1 || major > 3)
    throw Error(fmt::format("unsupported .npy version {}.{} (supported: 1.0, 2.0, 3.0)", major, byte(preamble, 7)));
  std::int64_t length = byte(preamble, 8) | byte(preamble, 9) << 8;
  if (major > 1) length |= static_cast<std::int64_t>(byte(preamble, 10) << 16 | byte(preamble, 11) << 24);
  if (length > kLargestNpyHeader) refuse(fmt::format("length of {} bytes", length));
  return (major == 1 ? 10 : 12) + length;
}

NpyHeader parse_npy_header(std::string_view bytes) { return parse(bytes, false); }

NpyHeader parse_npy_table_header(std::string_view bytes) { return parse(bytes, true); }

}  // namespace scarp
