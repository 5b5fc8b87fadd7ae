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

constexpr int kFailed = 1, kWrongUsage = 2;

int fail(std::string text, int status) {
  scarp::cli::end_progress_line();
  // One line, whatever a file name or a library has put into it.
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::fprintf(stderr, "scarp: %s\n", text.c_str());
  return status;
}

// "--fov 'x': expected a number" for a value that CLI11 could not convert.
std::string unconverted(const CLI::ConversionError& error, const CLI::App& called) {
  for (const CLI::Option* option : called.get_options()) {
    const std::string name = option->get_name();
    const std::string before = "Could not convert: " + name + " = ", text = error.what();
    if (!text.starts_with(before)) continue;
    return name + " '" + text.substr(before.size()) + "': expected " +
           (option->get_type_name() == "FLOAT" ? "a number" : "a whole number");
  }
  return error.what();
}

std::string wrong_usage(const CLI::ParseError& error, const CLI::App& called) {
  if (const auto* conversion = dynamic_cast<const CLI::ConversionError*>(&error)) {
    return unconverted(*conversion, called);
  }
  if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr) {
    // "--fov: 'x': expected ..." as the others are told.
    std::string text = error.what();
    const std::size_t end = text.find(": '");
    if (end != std::string::npos && text.find("expected", end) != std::string::npos) text.erase(end, 1);
    return text;
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    // What is missing was perhaps given, under a name that is wrong.
    for (const std::string& argument : called.remaining()) {
      if (argument.starts_with('-')) return "The following argument was not expected: " + argument;
    }
  }
  return error.what();
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
    const auto subcommands = program.get_subcommands();
    const CLI::App& called = subcommands.empty() ? program : *subcommands.front();
    const std::string help = subcommands.empty() ? "scarp --help" : "scarp " + called.get_name() + " --help";
    return fail(wrong_usage(error, called) + "; '" + help + "' tells what there is", kWrongUsage);
  } catch (const scarp::Interrupted& error) {
    return fail(error.what(), scarp::cli::kSignalled + scarp::cli::caught_signal());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; a smaller window or picture needs less", kFailed);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailed);
  }
}
