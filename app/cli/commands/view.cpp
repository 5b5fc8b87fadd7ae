// SPDX-License-Identifier: MIT
// `scarp view`: starts the program scarp-view, which is linked to the window's libraries.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/view_options.h"
#include "scarp/base/error.h"

namespace scarp::cli {

void add_view(Program& program) {
  const auto options = std::make_shared<ViewOptions>();
  declare_view(program, *options).runs([options, &program] {
    std::error_code none;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", none);
    const std::string window = (self.parent_path() / "scarp-view").string();
    std::vector<std::string> words = program.words();
    words.insert(words.begin(), window);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execv(window.c_str(), arguments.data());
    throw Error(fmt::format("'{}': cannot be started: {} (it comes with the build option SCARP_VIEWER)", window,
                            std::strerror(errno)));
  });
}

}  // namespace scarp::cli
