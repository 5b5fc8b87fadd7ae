// SPDX-License-Identifier: MIT
// .zip archives, which GDAL reads as folders: /vsizip/ARCHIVE/MEMBER.
//
// Source: PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", 6.3.10, 4.3.16: the end record.
#pragma once

#include <string>
#include <vector>

namespace scarp {

/// Whether the file begins as archives do.
bool is_zip(const std::string& path);

/// Whether the record is there that archives end with, without which nothing in them is found.
bool has_zip_end(const std::string& path);

/// GDAL's name of the archive as a folder. /vsizip wants the full name, in braces when it does not end in .zip.
std::string zip_folder(const std::string& path);

/// All files in it, with their folders.
std::vector<std::string> zip_members(const std::string& path);

}  // namespace scarp
