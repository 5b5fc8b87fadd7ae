// SPDX-License-Identifier: MIT
// The command line: runs the subcommand, and turns any failure into one line and an exit status.
//
//   0 done   1 failed (files, data, values)   2 wrong usage   128 + n ended by signal n
#pragma once

namespace scarp::cli {

/// The body of main(). Call once per process: signal handlers and progress are global.
int run_command_line(int argc, char** argv);

class Program;
/// The same with the subcommands of `program`; also to be called once per process.
int run_program(Program& program, int argc, char** argv);

}  // namespace scarp::cli
