// SPDX-License-Identifier: MIT
#include "app/cli/picture/film.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cli/progress.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

constexpr int kPoll_ms = 20;

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

[[noreturn]] void refuse_system(const std::string& what) {
  throw Error(fmt::format("{} ({})", what, std::strerror(errno)));
}

}  // namespace

// A running program that reads frames from its standard input. It is killed if it has not finished.
class Film::Encoder {
 public:
  explicit Encoder(std::vector<std::string> words) : messages_(std::tmpfile()) {
    if (messages_ == nullptr) refuse_system("a temporary file cannot be created");
    // A socket: unlike writes to a pipe, sends can leave SIGPIPE out.
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
      std::fclose(messages_);
      refuse_system("a socket cannot be created");
    }
    socket_ = ends[0];
    // A parent may have ignored it, and then the exit status would be lost.
    std::signal(SIGCHLD, SIG_DFL);
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    ::posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
    for (const int stream : {1, 2}) ::posix_spawn_file_actions_adddup2(&actions, ::fileno(messages_), stream);
    const int error = ::posix_spawn(&child_, argv.front(), &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (error == 0) return;
    close();
    std::fclose(messages_);
    throw Error(fmt::format("{}: cannot be started ({})", words.front(), std::strerror(error)));
  }
  ~Encoder() {
    close();
    if (child_ != 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
    std::fclose(messages_);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  // Returns false if the program no longer reads.
  bool write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ::ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (sent >= 0) {
        bytes.remove_prefix(static_cast<std::size_t>(sent));
        continue;
      }
      if (errno != EAGAIN && errno != EINTR) return false;
      stop_if_interrupted();
      ::pollfd place{socket_, POLLOUT, 0};
      ::poll(&place, 1, kPoll_ms);
    }
    return true;
  }

  // Ends its input and waits. Returns whether it succeeded.
  bool finish() {
    close();
    int status = -1;
    ::pid_t ended = 0;
    while ((ended = ::waitpid(child_, &status, WNOHANG)) == 0) {
      stop_if_interrupted();
      ::poll(nullptr, 0, kPoll_ms);
    }
    const bool known = ended == std::exchange(child_, 0);
    stop_if_interrupted();
    return known && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  // The last line of its messages that is not blank.
  std::string last_message() const {
    std::string line, last;
    std::rewind(messages_);
    for (int c = 0; c != EOF;) {
      c = std::fgetc(messages_);
      if (c != '\n' && c != EOF) {
        line += static_cast<char>(c);
        continue;
      }
      if (line.find_first_not_of(" \r\t") != std::string::npos) last = line;
      line.clear();
    }
    return last;
  }

 private:
  void close() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  }

  std::FILE* messages_;  // has no name: nothing is left behind
  int socket_ = -1;
  ::pid_t child_ = 0;
};

bool is_film(const std::string& output) {
  const std::string extension = extension_of(output);
  return extension == ".gif" || extension == ".mp4";
}

Film::Film(std::string output)
    : output_(std::move(output)),
      program_(program_in_path("ffmpeg")),
      file_(output_),
      frame_(file_.temporary_path() + ".png") {
  if (!program_.empty()) return;
  throw Error(
      fmt::format("output '{}': films need the program ffmpeg, which is not installed (install it, or name "
                  "the output frame-####.png)",
                  output_));
}

Film::~Film() = default;

void Film::refuse() const {
  const std::string why = encoder_->last_message();
  throw Error(fmt::format("output '{}': ffmpeg failed{}", output_, why.empty() ? "" : fmt::format(" ({})", why)));
}

void Film::add_frame(double frames_per_second) {
  if (!encoder_) {
    std::vector<std::string> words{program_, "-v",         "error",      "-y",
                                   "-f",     "image2pipe", "-framerate", fmt::format("{}", frames_per_second),
                                   "-c:v",   "png",        "-i",         "-"};
    // GIF has 256 colours, chosen for the film. MP4 players need even sides and 4:2:0.
    const std::vector<std::string> kind =
        extension_of(output_) == ".gif"
            ? std::vector<std::string>{"-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse"}
            : std::vector<std::string>{"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"};
    words.insert(words.end(), kind.begin(), kind.end());
    words.push_back(file_.temporary_path());
    encoder_ = std::make_unique<Encoder>(std::move(words));
  }
  if (encoder_->write(whole_file(frame(), ""))) return;
  // Its end is known once it has been waited for.
  encoder_->finish();
  refuse();
}

void Film::finish() {
  if (!encoder_->finish()) refuse();
  file_.commit();
}

}  // namespace scarp::cli
