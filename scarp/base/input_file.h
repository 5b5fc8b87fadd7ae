// SPDX-License-Identifier: MIT
// The check that all readers make before they open a file.
#pragma once

#include <string>

namespace scarp {

/// Throws Error, whose text starts with `subject`, if `path` is a pipe, a socket or a device: opening or reading it may
/// block forever. Accepts files, folders, paths that do not exist, and streams that the program was started with
/// (/dev/stdin, /dev/fd/N), which are open already.
void refuse_special_file(const std::string& path, const std::string& subject = {});

}  // namespace scarp
