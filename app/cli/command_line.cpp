// SPDX-License-Identifier: MIT
#include "app/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "app/cli/commands.h"
#include "app/cli/progress.h"
#include "app/cli/wrong_usage.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

constexpr int kFailed = 1;

int fail(std::string text, int status) {
  end_progress_line();
  // One line, whatever a file name or a library has put into it.
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::fprintf(stderr, "scarp: %s\n", text.c_str());
  return status;
}

int flush_output() {
  // Who has flushed before, as CLI11 does, has had the error, too.
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  return fail("standard output cannot be written; is the disk full?", kFailed);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App program("Exact ray marching of terrain: elevation models in, pictures and hits out.", "scarp");
  program.set_version_flag("--version", "scarp " SCARP_VERSION);
  program.require_subcommand(0, 1);
  add_render(program);
  add_cast(program);
  add_composite(program);
  add_info(program);
  add_generate(program);
  add_marches(program);
  add_replay(program);
  add_voxelise(program);
  add_section(program);
#ifdef SCARP_VULKAN
  add_devices(program);
#endif
  if (argc < 2) {
    std::fputs(program.help().c_str(), stderr);
    return kWrongUsage;
  }
  catch_interrupts();
  try {
    program.parse(argc, argv);
    return flush_output();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      program.exit(error);
      return flush_output();
    }
    const std::string word = unknown_subcommand(program);
    std::error_code no_file;
    if (!word.empty() && std::filesystem::exists(word, no_file))
      return fail("'" + word + "': is a file and no subcommand; did you mean 'scarp render " + word + " -o out.png'?",
                  kWrongUsage);
    return fail(wrong_usage(error, program), kWrongUsage);
  } catch (const Interrupted& error) {
    return fail(error.what(), kSignalled + caught_signal());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; a smaller window or picture needs less", kFailed);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailed);
  }
}

}  // namespace scarp::cli
