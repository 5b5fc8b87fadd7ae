// SPDX-License-Identifier: MIT
#include "scarp/output/output_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// Size of the pieces written to the file.
constexpr std::size_t kBytesPerPiece = 1 << 20;
constexpr const char* kNotWritten = "cannot be written (is the disk full?)";

}  // namespace

void OutputFile::Closer::operator()(std::FILE* file) const {
  if (file != stdout) std::fclose(file);
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  if (path.empty()) {
    file_.reset(stdout);
    return;
  }
  place_ = std::make_unique<ReplaceFile>(path);
  file_.reset(std::fopen(place_->temporary_path().c_str(), "wb"));
  if (!file_) refuse(std::strerror(errno));
}

OutputFile::~OutputFile() = default;

void OutputFile::refuse(std::string_view what) const {
  throw Error(fmt::format("{}: {}", path_.empty() ? "standard output" : path_, what));
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) refuse(kNotWritten);
}

void OutputFile::add(std::string_view bytes) {
  waiting_ += bytes;
  if (waiting_.size() < kBytesPerPiece) return;
  write(waiting_);
  waiting_.clear();
}

void OutputFile::commit(std::string_view header) {
  write(waiting_);
  waiting_.clear();
  if (!header.empty() && place_) {
    if (std::fseek(file_.get(), 0, SEEK_SET) != 0) refuse(std::strerror(errno));
    write(header);
  }
  if (std::fflush(file_.get()) != 0) refuse(kNotWritten);
  if (!place_) return;
  if (std::fclose(file_.release()) != 0) refuse(kNotWritten);
  place_->commit();
}

}  // namespace scarp
