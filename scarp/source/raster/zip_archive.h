// SPDX-License-Identifier: MIT
// .zip archives, which GDAL reads as folders: /vsizip/ARCHIVE/MEMBER.
//
// Source: PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", 6.3.10, 4.3.16: the end record.
#pragma once

#include <string>
#include <vector>

namespace scarp {

/// Returns whether the file starts like a .zip archive.
bool is_zip(const std::string& path);

/// Returns whether the file has the end record, without which its members cannot be found.
bool has_zip_end(const std::string& path);

/// Returns GDAL's folder name of the archive. /vsizip requires the full name, in braces unless it ends in .zip.
std::string zip_folder(const std::string& path);

/// Returns all files in the archive, with their folders.
std::vector<std::string> zip_members(const std::string& path);

}  // namespace scarp
