// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstdlib>

#include "app/cli/command_line.h"

int main(int argc, char** argv) {
  const int status = scarp::cli::run_command_line(argc, argv);
#ifdef NDEBUG
  // What is left to destroy belongs to libraries, whose destructors only free memory. The system does so faster.
  std::fflush(nullptr);
  std::_Exit(status);
#else
  return status;
#endif
}
