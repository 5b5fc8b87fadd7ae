// SPDX-License-Identifier: MIT
#include "scarp/output/gdal_writing.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <system_error>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// Whether a file of these bytes may have failed for lack of space. Compression makes files smaller, overviews larger.
bool may_be_full(const std::string& path, double bytes, const std::string& reason) {
  for (const int error : {ENOSPC, EFBIG, EDQUOT})
    if (reason.find(std::strerror(error)) != std::string::npos) return true;
  constexpr double kOverviews = 2;
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      static_cast<double>(limit.rlim_cur) < kOverviews * bytes)
    return true;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code failed;
  const auto space = std::filesystem::space(folder.empty() ? "." : folder, failed);
  return !failed && static_cast<double>(space.available) < kOverviews * bytes;
}

}  // namespace

GdalWriting::GdalWriting(AuxiliaryFiles auxiliary) {
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
  auxiliary_.emplace("GDAL_PAM_ENABLED", auxiliary == AuxiliaryFiles::written ? "YES" : "NO", false);
  CPLPushErrorHandlerEx(&GdalWriting::note, this);
}

GdalWriting::~GdalWriting() { CPLPopErrorHandler(); }

void CPL_STDCALL GdalWriting::note(CPLErr level, CPLErrorNum, const char* text) {
  auto* writing = static_cast<GdalWriting*>(CPLGetErrorHandlerUserData());
  if (level < CE_Failure || !writing->first_.empty()) return;
  writing->first_ = text;
  const std::string& hidden = writing->hidden_;
  for (std::size_t at = 0; !hidden.empty() && (at = writing->first_.find(hidden)) != std::string::npos;)
    writing->first_.erase(at, hidden.size());
  std::replace(writing->first_.begin(), writing->first_.end(), '\n', ' ');
}

void GdalWriting::require_good(const std::string& path, double bytes) const {
  if (first_.empty()) return;
  throw Error(fmt::format("{}: cannot be written: {}{}", path, first_,
                          may_be_full(path, bytes, first_) ? " (is the disk full?)" : ""));
}

void require_size(const RgbView& picture, int most_side, const std::string& path, const char* format) {
  const int least = std::min(picture.width, picture.height), most = std::max(picture.width, picture.height);
  if (picture.data != nullptr && least >= 1 && most <= most_side) return;
  throw Error(fmt::format("{}: image of {} x {} pixels ({} holds 1 to {} from side to side)", path, picture.width,
                          picture.height, format, most_side));
}

}  // namespace scarp
