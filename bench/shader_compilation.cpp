// SPDX-License-Identifier: MIT
#include "bench/shader_compilation.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "scarp/accel/max_pyramid_vk.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/function/function_queries_vk.h"
#include "scarp/march/height/queries_vk.h"
#include "scarp/march/shape/shape_queries_vk.h"
#include "scarp/march/voxel/voxel_pictures_vk.h"
#include "scarp/march/voxel/voxel_queries_vk.h"
#include "scarp/render/frame/terrain_frame_vk.h"
#include "scarp/vk/shader_statistics.h"

namespace scarp::bench {
namespace {

// RADV's manifests in the search path of Vulkan's loader. There may be one per architecture; the loader uses the
// matching one.
std::string radv_manifests() {
  std::string all;
  for (const char* folder : {"/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/share/vulkan/icd.d"}) {
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
      const std::string name = entry.path().filename();
      if (!name.starts_with("radeon_icd.") || !name.ends_with(".json")) continue;
      if (!all.empty()) all += ':';
      all += entry.path().string();
    }
  }
  return all;
}

// Devices opened from now on are RADV's null device, which reads the family when an instance is created.
void use_radv(const std::string& family) {
  const std::string manifests = radv_manifests();
  if (manifests.empty()) {
    throw Error("RADV, which compiles for AMD cards, is not installed (on Debian, install mesa-vulkan-drivers)");
  }
  const std::pair<const char*, std::string> variables[] = {
      {"VK_DRIVER_FILES", manifests}, {"VK_ICD_FILENAMES", manifests},  // the same for older loaders
      {"RADV_FORCE_FAMILY", family},  {"MESA_SHADER_CACHE_DISABLE", "true"},
      {"NODEVICE_SELECT", "1"},  // Mesa's layer that sorts devices, which queries the window system
  };
  for (const auto& [name, value] : variables) ::setenv(name, value.c_str(), 1);
  // Figures must be those of the driver's defaults.
  for (const char* name : {"RADV_DEBUG", "RADV_PERFTEST", "ACO_DEBUG"}) ::unsetenv(name);
}

// RADV aborts the process on an unknown name, so another process tries it.
void require_family(const std::string& family) {
  use_radv(family);
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::close(STDERR_FILENO);
    try {
      const ShaderCompiler compiler;
    } catch (const Error&) {  // the parent detects it as well
    }
    ::_exit(0);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) throw Error("shaders: cannot start a process");
  if (!WIFEXITED(status)) {
    throw Error(fmt::format("RADV knows no family '{}' (others: polaris10, vega10, navi10, navi21)", family));
  }
}

}  // namespace

std::vector<ShaderProgram> library_shaders() {
  std::vector<ShaderProgram> all;
  for (const auto& some : {pyramid_shaders(), height_query_shaders(), function_query_shaders(), shape_query_shaders(),
                           voxel_query_shaders(), voxel_picture_shaders(), terrain_frame_shaders()}) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::string shader_compilers(const std::string& family) {
  require_family(family);
  return fmt::format("{}, {}", ShaderCompiler().driver(), SCARP_BENCH_GLSLC);
}

std::string shader_disassembly(const ShaderProgram& program, const std::string& family) {
  require_family(family);
  return ShaderCompiler().disassembly(program);
}

ShaderTable compile_shaders(const std::vector<ShaderProgram>& programs, const std::vector<std::string>& families) {
  ShaderTable table;
  // Called for all families before any thread starts, because it forks a process.
  for (const std::string& family : families) table.compilers = shader_compilers(family);
  table.rows.resize(programs.size() * families.size());
  for (std::size_t f = 0; f < families.size(); ++f) {
    use_radv(families[f]);
    const ShaderCompiler compiler;
    parallel_for(static_cast<std::int64_t>(programs.size()), 1, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        ShaderRow& row = table.rows[i * families.size() + f];
        row = {std::string(programs[i].file), programs[i].variant, families[f], {}};
        for (const auto& [name, value] : compiler.statistics(programs[i])) {
          for (std::size_t k = 0; k < kShaderFigures.size(); ++k) {
            if (kShaderFigures[k].driver_name == name) row.figures[k] = static_cast<std::int64_t>(value);
          }
        }
      }
    });
  }
  return table;
}

}  // namespace scarp::bench
