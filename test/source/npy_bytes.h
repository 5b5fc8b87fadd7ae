// SPDX-License-Identifier: MIT
// .npy files as byte strings, written as numpy.lib.format does.
#pragma once

#include <cstring>
#include <iterator>
#include <string>
#include <vector>

namespace scarp::test {

inline std::string npy_bytes(const std::string& dictionary, const std::string& samples, int version = 1) {
  const std::size_t preamble = version == 1 ? 10 : 12;
  std::string text = dictionary;
  text.append(63 - (preamble + text.size()) % 64, ' ');
  text += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  for (std::size_t i = 0; i < (version == 1 ? 2u : 4u); ++i) bytes += static_cast<char>(text.size() >> (8 * i) & 0xff);
  return bytes + text + samples;
}

/// The values as T, in the given byte order (this machine is taken to be little-endian).
template <class T>
std::string sample_bytes(const std::vector<double>& values, bool big_endian = false) {
  std::string bytes;
  for (const double value : values) {
    const T sample = static_cast<T>(value);
    char raw[sizeof(T)];
    std::memcpy(raw, &sample, sizeof(T));
    bytes += big_endian ? std::string(std::make_reverse_iterator(raw + sizeof(T)), std::make_reverse_iterator(raw))
                        : std::string(raw, sizeof(T));
  }
  return bytes;
}

inline std::string npy_dictionary(const std::string& descr, const std::string& shape, bool fortran = false) {
  return "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
}

}  // namespace scarp::test
