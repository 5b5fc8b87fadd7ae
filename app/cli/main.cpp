// SPDX-License-Identifier: MIT
// The command line: finds the subcommand, and turns whatever went wrong into one line and an exit status.
//
//   0 done   1 failed (files, data, values)   2 wrong usage   128 + n ended by signal n
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "app/cli/commands.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"

namespace {

constexpr int kFailed = 1, kWrongUsage = 2, kSignalled = 128;

int fail(std::string text, int status) {
  scarp::cli::end_progress_line();
  // One line, whatever a file name or a library has put into it.
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::fprintf(stderr, "scarp: %s\n", text.c_str());
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Exact ray marching of terrain: elevation models in, pictures and hits out.", "scarp");
  program.set_version_flag("--version", "scarp " SCARP_VERSION);
  program.require_subcommand(0, 1);
  scarp::cli::add_render(program);
  scarp::cli::add_cast(program);
  scarp::cli::add_info(program);
  scarp::cli::add_generate(program);
  scarp::cli::add_marches(program);
  scarp::cli::add_replay(program);
  if (argc < 2) {
    std::fputs(program.help().c_str(), stderr);
    return kWrongUsage;
  }
  scarp::cli::catch_interrupts();
  try {
    program.parse(argc, argv);
    if (std::fflush(stdout) != 0) return fail("standard output cannot be written; is the disk full?", kFailed);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    const auto called = program.get_subcommands();
    const std::string help = called.empty() ? "scarp --help" : "scarp " + called.front()->get_name() + " --help";
    return fail(std::string(error.what()) + "; '" + help + "' tells what there is", kWrongUsage);
  } catch (const scarp::Interrupted& error) {
    return fail(error.what(), kSignalled + scarp::cli::caught_signal());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; a smaller window or picture needs less", kFailed);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailed);
  }
}
