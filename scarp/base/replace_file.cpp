// SPDX-License-Identifier: MIT
#include "scarp/base/replace_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>
#include <utility>

#include "scarp/base/error.h"

namespace scarp {

namespace fs = std::filesystem;

// An append-only list with reusable entries: a signal handler walks it without a lock and never accesses freed memory.
// The thread that removes a name from its entry owns the name.
struct NotedName {
  std::atomic<char*> name;
  NotedName* next;

  static NotedName* note(const std::string& path) {
    char* const copy = ::strdup(path.c_str());
    if (copy == nullptr) throw std::bad_alloc();
    for (NotedName* place = first.load(); place != nullptr; place = place->next) {
      char* none = nullptr;
      if (place->name.compare_exchange_strong(none, copy)) return place;
    }
    auto* const place = new NotedName{copy, first.load()};
    while (!first.compare_exchange_weak(place->next, place)) continue;
    return place;
  }
  void forget() { std::free(name.exchange(nullptr)); }

  static std::atomic<NotedName*> first;
};
std::atomic<NotedName*> NotedName::first = nullptr;
static_assert(std::atomic<char*>::is_always_lock_free);

namespace {

// Removes a folder that contains only files. readdir() may allocate memory, which is not safe in a signal handler.
void remove_folder(const char* name) noexcept {
#ifdef SYS_getdents64
  const int folder = ::open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  // struct linux_dirent64: its size is at byte 16, its name at byte 19.
  char entries[4096];
  for (long size = 0; (size = ::syscall(SYS_getdents64, folder, entries, sizeof entries)) > 0;) {
    for (long at = 0; at < size;) {
      unsigned short bytes = 0;
      std::memcpy(&bytes, entries + at + 16, sizeof bytes);
      ::unlinkat(folder, entries + at + 19, 0);  // fails for . and ..
      at += bytes;
    }
  }
  ::close(folder);
#endif
  ::rmdir(name);
}

}  // namespace

void remove_temporary_files() noexcept {
  for (NotedName* place = NotedName::first.load(); place != nullptr; place = place->next) {
    // The name is not freed: free() is not safe in a signal handler.
    const char* name = place->name.exchange(nullptr);
    if (name != nullptr && ::unlink(name) != 0 && (errno == EISDIR || errno == EPERM)) remove_folder(name);
  }
}

ReplaceFile::ReplaceFile(std::string path) : path_(std::move(path)) {
  if (path_.empty()) throw Error("output file name is empty (name a file)");
  std::error_code ignored;
  // Symbolic links are followed; otherwise rename() would replace the link itself.
  if (fs::is_symlink(path_, ignored)) path_ = fs::weakly_canonical(path_, ignored).string();
  const fs::path target(path_);
  if (fs::is_directory(target, ignored)) throw Error(fmt::format("{}: is a directory (name a file)", path_));
  if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored)) {
    throw Error(fmt::format("{}: is a device or another special file (name a regular file)", path_));
  }
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw Error(fmt::format("{}: folder '{}' does not exist (create it first)", path_, folder.string()));
  }
  if (fs::exists(target, ignored) && ::access(path_.c_str(), W_OK) != 0) {
    throw Error(fmt::format("{}: exists and is write-protected (choose another name)", path_));
  }
  temporary_ =
      (folder / fmt::format(".{}.{}.part{}", target.stem().string(), ::getpid(), target.extension().string())).string();
  // Opened here so that a folder that is not writable is reported before hours of work, not after.
  noted_ = NotedName::note(temporary_);
  if (!std::ofstream(temporary_, std::ios::binary)) {
    noted_->forget();
    throw Error(fmt::format("{}: folder '{}' is not writable (choose another folder)", path_, folder.string()));
  }
}

TemporaryFolder::TemporaryFolder(const std::string& path) {
  const fs::path target(path);
  // Not the name of a ReplaceFile: both may exist for one path.
  name_ = (target.parent_path() / fmt::format(".{}.{}.parts", target.filename().string(), ::getpid())).string();
  noted_ = NotedName::note(name_);
  if (::mkdir(name_.c_str(), 0777) == 0) return;
  const int why = errno;
  noted_->forget();
  throw Error(fmt::format("{}: cannot create a folder beside it: {}", path, std::strerror(why)));
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(name_, ignored);
  noted_->forget();
}

ReplaceFile::~ReplaceFile() {
  if (temporary_.empty()) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  noted_->forget();
}

void ReplaceFile::commit() {
  std::error_code error, none;
  // A rewritten file keeps its permissions, regardless of those of the temporary file.
  const fs::file_status before = fs::status(path_, none);
  const fs::perms wanted = before.permissions() & fs::perms::all;
  if (fs::exists(before) && (fs::status(temporary_, none).permissions() & fs::perms::all) != wanted) {
    fs::permissions(temporary_, wanted, error);
    if (error) throw Error(fmt::format("{}: cannot restore its permissions: {}", path_, error.message()));
  }
  fs::rename(temporary_, path_, error);
  if (error) throw Error(fmt::format("{}: cannot rename the temporary file: {}", path_, error.message()));
  noted_->forget();
  temporary_.clear();
}

}  // namespace scarp
