// SPDX-License-Identifier: MIT
#include "app/cli/command_line.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/gdal_words.h"
#include "app/cli/memory/file_memory.h"
#include "app/cli/progress.h"
#include "app/options/help.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

constexpr int kFailed = 1, kWrongUsage = 2;

int fail(std::string text, int status) {
  end_progress_line();
  // Keeps the message on one line, even if a file name or a library has put line breaks into it.
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::fprintf(stderr, "scarp: error: %s\n", text.c_str());
  return status;
}

int fail_output() { return fail("standard output: cannot be written (is the disk full?)", kFailed); }

int flush_output() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? 0 : fail_output(); }

}  // namespace

ProgramAbout about_scarp() {
  return {.name = "scarp",
          .version = SCARP_VERSION,
          .summary = "Exact ray marching of terrain and voxels: elevation models in, pictures and hits out.",
          .example = "scarp render dem.tif -o dem.png",
          .with_file = [](const std::string& file) { return "scarp render " + file + " -o out.png"; },
          .reworded =
              [](const std::vector<std::string>& words) {
                const bool map = !words.empty() && (words[0] == "viewshed" || words[0] == "shadow");
                return map ? without_gdal_words(words) : words;
              }};
}

Program scarp_program() {
  Program program(about_scarp());
  add_render(program);
#ifdef SCARP_VIEWER
  add_view(program);
#endif
  add_cast(program);
  add_composite(program);
  add_viewshed(program);
  add_shadow(program);
  add_horizon(program);
  add_skyview(program);
#ifdef SCARP_ERFA
  add_sunhours(program);
#endif
  add_los(program);
  add_profile(program);
  add_contours(program);
  add_merge(program);
  add_info(program);
  add_generate(program);
  add_marches(program);
  add_replay(program);
  add_voxelise(program);
  add_section(program);
#ifdef SCARP_VULKAN
  add_devices(program);
#endif
  add_options(program);
  return program;
}

int run_command_line(int argc, char** argv) {
  Program program = scarp_program();
  return run_program(program, argc, argv);
}

int run_program(Program& program, int argc, char** argv) {
  if (argc < 2) {
    std::fputs(help_text(program).c_str(), stderr);
    return kWrongUsage;
  }
  catch_interrupts();
  try {
    program.run(argc, argv);
    return flush_output();
  } catch (const WrongUsage& error) {
    return fail(error.what(), kWrongUsage);
  } catch (const Interrupted& error) {
    end_progress_line();
    std::fprintf(stderr, "scarp: %s\n", error.what());
    return kSignalled + caught_signal();
  } catch (const NoFileMemory& error) {
    return fail(error.what(), kFailed);
  } catch (const std::bad_alloc&) {
    return fail("out of memory (a smaller window or picture needs less)", kFailed);
  } catch (const std::exception& error) {
    // fmt::print() has thrown, without the name of the stream.
    return std::ferror(stdout) != 0 ? fail_output() : fail(error.what(), kFailed);
  }
}

}  // namespace scarp::cli
