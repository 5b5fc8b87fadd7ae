// SPDX-License-Identifier: MIT
#include "scarp/output/npy_array.h"

#include <fmt/format.h>

#include <limits>

namespace scarp {

std::string npy_array_header(std::span<const NpyColumn> columns, std::int64_t rows) {
  std::string fields;
  for (const NpyColumn& column : columns) fields += fmt::format("('{}', '{}'), ", column.name, column.type);
  constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
  constexpr std::size_t kAlignment = 64;
  constexpr int kWidestCount = std::numeric_limits<std::int64_t>::digits10 + 1;
  const std::string count = fmt::format("{}", rows);
  std::string dictionary = fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}",
                                       std::string_view(fields).substr(0, fields.size() - 2), count);
  dictionary.append(kWidestCount - count.size(), ' ');
  const std::size_t unpadded = kMagic.size() + 2 + dictionary.size() + 1;
  dictionary.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  dictionary += '\n';
  std::string header(kMagic);
  header += static_cast<char>(dictionary.size() & 0xff);
  header += static_cast<char>(dictionary.size() >> 8 & 0xff);
  return header + dictionary;
}

}  // namespace scarp
