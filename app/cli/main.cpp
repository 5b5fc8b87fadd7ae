// SPDX-License-Identifier: MIT
#include "app/cli/command_line.h"

int main(int argc, char** argv) { return scarp::cli::run_command_line(argc, argv); }
