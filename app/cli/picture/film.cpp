// SPDX-License-Identifier: MIT
#include "app/cli/picture/film.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"

namespace scarp::cli {
namespace {

constexpr std::chrono::milliseconds kPoll{20};

// The program's path; empty if it is not in PATH.
std::string program_in_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string folders = path ? path : "";
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const std::string file = folders.substr(begin, end - begin) + "/" + name;
    if (end > begin && ::access(file.c_str(), X_OK) == 0) return file;
    begin = end + 1;
  }
  return {};
}

std::string new_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "scarp-film-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw Error(fmt::format("{}: cannot be created ({})", name, std::strerror(errno)));
  return name;
}

// Runs a program without input, with its messages in a file. Returns whether it succeeded. After a signal the program
// ends, too.
bool run(std::vector<std::string> words, const std::string& messages) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, 1, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::posix_spawn_file_actions_adddup2(&actions, 1, 2);
  ::pid_t child = 0;
  const int error = ::posix_spawn(&child, argv.front(), &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw Error(fmt::format("{}: cannot be started ({})", words.front(), std::strerror(error)));
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (caught_signal() != 0) {
      ::kill(child, SIGTERM);
      ::waitpid(child, &status, 0);
    } else {
      std::this_thread::sleep_for(kPoll);
      continue;
    }
    break;
  }
  stop_if_interrupted();
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string last_line_of(const std::string& path) {
  std::ifstream in(path);
  std::string line, last;
  while (std::getline(in, line)) {
    if (line.find_first_not_of(" \r\t") != std::string::npos) last = line;
  }
  return last;
}

}  // namespace

bool is_film(const std::string& output) {
  const std::string extension = extension_of(output);
  return extension == ".gif" || extension == ".mp4";
}

Film::Film(std::string output) : output_(std::move(output)), file_(output_), program_(program_in_path("ffmpeg")) {
  if (program_.empty()) {
    throw Error(
        fmt::format("output '{}': films need the program ffmpeg, which is not installed (install it, or name "
                    "the output frame-####.png)",
                    output_));
  }
  folder_ = new_folder();
}

Film::~Film() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

std::string Film::frames() const { return folder_ + "/frame-######.png"; }

void Film::finish(double frames_per_second) {
  const std::string messages = folder_ + "/messages";
  std::vector<std::string> words{program_,     "-v",
                                 "error",      "-y",
                                 "-framerate", fmt::format("{}", frames_per_second),
                                 "-i",         folder_ + "/frame-%06d.png"};
  // GIF has 256 colours, chosen for the film. MP4 players need even sides and 4:2:0.
  const std::vector<std::string> kind =
      extension_of(output_) == ".gif"
          ? std::vector<std::string>{"-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse"}
          : std::vector<std::string>{"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"};
  words.insert(words.end(), kind.begin(), kind.end());
  words.push_back(file_.temporary_path());
  if (!run(std::move(words), messages)) {
    const std::string why = last_line_of(messages);
    throw Error(fmt::format("output '{}': ffmpeg failed{}", output_, why.empty() ? "" : fmt::format(" ({})", why)));
  }
  file_.commit();
}

}  // namespace scarp::cli
