// SPDX-License-Identifier: MIT
#include "scarp/base/replace_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
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
struct ReplaceFile::Noted {
  std::atomic<char*> name;
  Noted* next;

  static Noted* note(const std::string& path) {
    char* const copy = ::strdup(path.c_str());
    if (copy == nullptr) throw std::bad_alloc();
    for (Noted* place = first.load(); place != nullptr; place = place->next) {
      char* none = nullptr;
      if (place->name.compare_exchange_strong(none, copy)) return place;
    }
    auto* const place = new Noted{copy, first.load()};
    while (!first.compare_exchange_weak(place->next, place)) continue;
    return place;
  }
  void forget() { std::free(name.exchange(nullptr)); }

  static std::atomic<Noted*> first;
};
std::atomic<ReplaceFile::Noted*> ReplaceFile::Noted::first = nullptr;
static_assert(std::atomic<char*>::is_always_lock_free);

void remove_temporary_files() noexcept {
  for (ReplaceFile::Noted* place = ReplaceFile::Noted::first.load(); place != nullptr; place = place->next) {
    // The name is not freed: free() is not safe in a signal handler.
    if (const char* name = place->name.exchange(nullptr)) ::unlink(name);
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
  noted_ = Noted::note(temporary_);
  if (!std::ofstream(temporary_, std::ios::binary)) {
    noted_->forget();
    throw Error(fmt::format("{}: folder '{}' is not writable (choose another folder)", path_, folder.string()));
  }
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
