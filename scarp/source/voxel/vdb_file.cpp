// SPDX-License-Identifier: MIT
#include "scarp/source/voxel/vdb_file.h"

#include <fmt/format.h>

#include <fstream>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/voxel/vdb_module.h"

#ifdef SCARP_OPENVDB
#include <dlfcn.h>

#include <filesystem>

#include "scarp/base/replace_file.h"
#endif

namespace scarp {
namespace {

#ifdef SCARP_OPENVDB
// The module is next to the program or library that contains this code, both in a build folder and when installed; for
// programs that link the static library, it is where Scarp was installed.
const VdbModule& vdb_module() {
  static const VdbModule* const module = [] {
    Dl_info here{};
    std::vector<std::filesystem::path> places;
    if (::dladdr(reinterpret_cast<const void*>(&is_vdb_path), &here) != 0 && here.dli_fname) {
      std::error_code error;
      auto file = std::filesystem::canonical(here.dli_fname, error);
      // For a program, this is the name that it was started with.
      if (error) file = std::filesystem::read_symlink("/proc/self/exe", error);
      places = {file.parent_path().parent_path() / SCARP_VDB_FOLDER, file.parent_path() / "scarp"};
    }
    places.emplace_back(SCARP_VDB_INSTALLED);
    std::string reason;
    for (const auto& place : places) {
      const auto file = place / SCARP_VDB_MODULE;
      // RTLD_LOCAL keeps the module's symbols private.
      if (void* opened = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
        if (const void* found = ::dlsym(opened, kVdbModule)) return static_cast<const VdbModule*>(found);
      }
      std::error_code error;
      const char* why = ::dlerror();
      if (reason.empty() && std::filesystem::exists(file, error)) reason = why ? why : "";
    }
    throw Error(reason.empty() ? fmt::format("OpenVDB: {} is not installed", SCARP_VDB_MODULE)
                               : fmt::format("OpenVDB: {}", reason));
  }();
  return *module;
}
#else
[[noreturn]] const VdbModule& vdb_module() { throw Error("built without OpenVDB (CMake: -D SCARP_OPENVDB=ON)"); }
#endif

}  // namespace

bool is_vdb_path(std::string_view path) {
  const std::string extension = extension_of(std::string(path));
  return extension == ".vdb" || extension == ".nvdb";
}

VdbVoxels read_vdb(const std::string& path) {
  VdbVoxels voxels;
  std::string error;
  try {
    // The libraries' messages do not distinguish a missing file from one in another format.
    if (std::ifstream file(path, std::ios::binary); !file || file.peek() == std::ifstream::traits_type::eof())
      throw Error(file.eof() ? "empty file (0 bytes)" : "cannot be read");
    if (!vdb_module().read(path, voxels, error)) throw Error(error);
  } catch (const Error& reason) {
    throw Error(fmt::format("{}: {}", path, reason.what()));
  }
  return voxels;
}

void write_vdb(const std::string& path, const VdbVoxels& voxels) {
#ifdef SCARP_OPENVDB
  const VdbModule& module = vdb_module();
  ReplaceFile file(path);
  std::string error;
  if (!module.write(file.temporary_path(), voxels, error)) throw Error(fmt::format("{}: {}", path, error));
  file.commit();
#else
  static_cast<void>(voxels);
  throw Error(fmt::format("{}: built without OpenVDB (CMake: -D SCARP_OPENVDB=ON)", path));
#endif
}

}  // namespace scarp
