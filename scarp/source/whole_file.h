// SPDX-License-Identifier: MIT
// Files that are read whole.
#pragma once

#include <string>
#include <string_view>

namespace scarp {

/// The bytes of a file. Only so much of one that does not begin with `magic` as tells that, for a message: no memory
/// for what is no such file. Throws Error: not there, no file, not to be read to its end.
std::string whole_file(const std::string& path, std::string_view magic);

}  // namespace scarp
