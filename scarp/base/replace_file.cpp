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

// A list that only grows, of places that are used again: a handler of signals walks it without a lock and meets nothing
// that was freed. Who takes a name out of its place owns it.
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
    // Not freed: that is nothing for a handler of signals.
    if (const char* name = place->name.exchange(nullptr)) ::unlink(name);
  }
}

ReplaceFile::ReplaceFile(std::string path) : path_(std::move(path)) {
  if (path_.empty()) throw Error("output: the file name is empty; name a file");
  std::error_code ignored;
  // A link is followed, or else the rename would put the file in the link's place.
  if (fs::is_symlink(path_, ignored)) path_ = fs::weakly_canonical(path_, ignored).string();
  const fs::path target(path_);
  if (fs::is_directory(target, ignored)) throw Error(fmt::format("output '{}': is a directory; name a file", path_));
  if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored)) {
    throw Error(fmt::format("output '{}': is a device or the like and no file; name a file", path_));
  }
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw Error(fmt::format("output '{}': the folder '{}' does not exist; create it first", path_, folder.string()));
  }
  if (fs::exists(target, ignored) && ::access(path_.c_str(), W_OK) != 0) {
    throw Error(fmt::format("output '{}': exists and is write-protected; choose another name", path_));
  }
  temporary_ =
      (folder / fmt::format(".{}.{}.part{}", target.stem().string(), ::getpid(), target.extension().string())).string();
  // Opened here, so that an unwritable folder is found before hours of work and not after them.
  noted_ = Noted::note(temporary_);
  if (!std::ofstream(temporary_, std::ios::binary)) {
    noted_->forget();
    throw Error(
        fmt::format("output '{}': the folder '{}' cannot be written to; choose another one", path_, folder.string()));
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
  // Who may read a file does not change when it is written anew, whatever the writer made of the temporary one.
  const fs::file_status before = fs::status(path_, none);
  const fs::perms wanted = before.permissions() & fs::perms::all;
  if (fs::exists(before) && (fs::status(temporary_, none).permissions() & fs::perms::all) != wanted) {
    fs::permissions(temporary_, wanted, error);
    if (error) throw Error(fmt::format("output '{}': cannot keep its permissions: {}", path_, error.message()));
  }
  fs::rename(temporary_, path_, error);
  if (error) throw Error(fmt::format("output '{}': cannot be moved into place: {}", path_, error.message()));
  noted_->forget();
  temporary_.clear();
}

}  // namespace scarp
