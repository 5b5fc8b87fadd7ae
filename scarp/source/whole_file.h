// SPDX-License-Identifier: MIT
// Reads and writes whole files.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace scarp {

/// Returns the bytes of a file. First calls `believe` with up to 64 bytes from its start and its size; if that returns
/// false, returns only those bytes, so that no memory is allocated for a file of another kind. Exceptions of `believe`
/// propagate. Throws Error: missing, not a file, not readable to its end.
std::string whole_file(const std::string& path,
                       const std::function<bool(std::string_view first, std::uint64_t size)>& believe);
/// Returns the bytes of a file that starts with `magic`; for other files, only the first bytes, as above.
std::string whole_file(const std::string& path, std::string_view magic);

/// Writes a file atomically. Throws Error naming the path if it cannot be written.
void write_whole_file(const std::string& path, std::string_view bytes);

}  // namespace scarp
