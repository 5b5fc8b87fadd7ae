// SPDX-License-Identifier: MIT
#include "scarp/output/gdal_writing.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// GDAL would write metadata that the format cannot store to NAME.aux.xml, under the temporary name.
constexpr const char* kSideFiles = "GDAL_PAM_ENABLED";

}  // namespace

GdalWriting::GdalWriting() {
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
  CPLSetThreadLocalConfigOption(kSideFiles, "NO");
  CPLPushErrorHandlerEx(&GdalWriting::note, this);
}

GdalWriting::~GdalWriting() {
  CPLPopErrorHandler();
  CPLSetThreadLocalConfigOption(kSideFiles, nullptr);
}

void CPL_STDCALL GdalWriting::note(CPLErr level, CPLErrorNum, const char* text) {
  auto* writing = static_cast<GdalWriting*>(CPLGetErrorHandlerUserData());
  if (level < CE_Failure || !writing->first_.empty()) return;
  writing->first_ = text;
  std::replace(writing->first_.begin(), writing->first_.end(), '\n', ' ');
}

void GdalWriting::require_good(const std::string& path) const {
  if (!first_.empty()) throw Error(fmt::format("{}: cannot be written: {} (is the disk full?)", path, first_));
}

void require_size(const RgbView& picture, int most_side, const std::string& path, const char* format) {
  const int least = std::min(picture.width, picture.height), most = std::max(picture.width, picture.height);
  if (picture.data != nullptr && least >= 1 && most <= most_side) return;
  throw Error(fmt::format("{}: image of {} x {} pixels ({} holds 1 to {} from side to side)", path, picture.width,
                          picture.height, format, most_side));
}

}  // namespace scarp
