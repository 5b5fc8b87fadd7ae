// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstdlib>

#include "app/cli/command_line.h"

int main(int argc, char** argv) {
  const int status = scarp::cli::run_command_line(argc, argv);
#ifdef NDEBUG
  // The destructors of libraries would only free memory, which the system does faster.
  std::fflush(nullptr);
  std::_Exit(status);
#else
  return status;
#endif
}
