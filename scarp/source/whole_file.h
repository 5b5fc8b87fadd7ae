// SPDX-License-Identifier: MIT
// Files that are read and written whole.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace scarp {

/// The bytes of a file. No memory is taken for what is no such file: first `believe` is shown its first bytes, up to
/// 64, and its size; where that is false, they are all that is returned. What it throws goes through. Throws Error: not
/// there, no file, not to be read to its end.
std::string whole_file(const std::string& path,
                       const std::function<bool(std::string_view first, std::uint64_t size)>& believe);
/// The same; believed is what begins with `magic`.
std::string whole_file(const std::string& path, std::string_view magic);

/// A file of these bytes, there whole or not at all. Throws Error naming the path.
void write_whole_file(const std::string& path, std::string_view bytes);

}  // namespace scarp
