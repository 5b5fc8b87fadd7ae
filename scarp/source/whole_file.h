// SPDX-License-Identifier: MIT
// Files that are read and written whole.
#pragma once

#include <string>
#include <string_view>

namespace scarp {

/// The bytes of a file. Only so much of one that does not begin with `magic` as tells that, for a message: no memory
/// for what is no such file. Throws Error: not there, no file, not to be read to its end.
std::string whole_file(const std::string& path, std::string_view magic);

/// A file of these bytes, there whole or not at all. Throws Error naming the path.
void write_whole_file(const std::string& path, std::string_view bytes);

}  // namespace scarp
