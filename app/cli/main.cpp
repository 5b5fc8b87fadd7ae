// SPDX-License-Identifier: MIT
// The command line: finds the subcommand, and turns whatever went wrong into one line and an exit status.
//
//   0 done   1 failed (files, data, values)   2 wrong usage   128 + n ended by signal n
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

namespace {

using scarp::cli::kWrongUsage;
constexpr int kFailed = 1;

int fail(std::string text, int status) {
  scarp::cli::end_progress_line();
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

int main(int argc, char** argv) {
  CLI::App program("Exact ray marching of terrain: elevation models in, pictures and hits out.", "scarp");
  program.set_version_flag("--version", "scarp " SCARP_VERSION);
  program.require_subcommand(0, 1);
  scarp::cli::add_render(program);
  scarp::cli::add_cast(program);
  scarp::cli::add_composite(program);
  scarp::cli::add_info(program);
  scarp::cli::add_generate(program);
  scarp::cli::add_marches(program);
  scarp::cli::add_replay(program);
  scarp::cli::add_voxelise(program);
  scarp::cli::add_section(program);
#ifdef SCARP_VULKAN
  scarp::cli::add_devices(program);
#endif
  if (argc < 2) {
    std::fputs(program.help().c_str(), stderr);
    return kWrongUsage;
  }
  scarp::cli::catch_interrupts();
  try {
    program.parse(argc, argv);
    return flush_output();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      program.exit(error);
      return flush_output();
    }
    const std::string word = scarp::cli::unknown_subcommand(program);
    std::error_code no_file;
    if (!word.empty() && std::filesystem::exists(word, no_file))
      return fail("'" + word + "': is a file and no subcommand; did you mean 'scarp render " + word + " -o out.png'?",
                  kWrongUsage);
    return fail(scarp::cli::wrong_usage(error, program), kWrongUsage);
  } catch (const scarp::Interrupted& error) {
    return fail(error.what(), scarp::cli::kSignalled + scarp::cli::caught_signal());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; a smaller window or picture needs less", kFailed);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailed);
  }
}
