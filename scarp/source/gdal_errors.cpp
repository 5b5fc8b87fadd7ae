// SPDX-License-Identifier: MIT
#include "scarp/source/gdal_errors.h"

#include <cpl_conv.h>
#include <gdal.h>

#include <algorithm>
#include <mutex>
#include <string_view>

namespace scarp {
namespace {

// Whether a text is meaningful only to GDAL's developers: it contains a memory address, or the placeholder 2^32 - 1.
bool is_riddle(std::string_view text) {
  return text.find("0x") != std::string_view::npos || text.find("4294967295") != std::string_view::npos;
}

std::string one_line(const char* text) {
  std::string line = text;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

}  // namespace

GdalSession::GdalSession() {
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
  CPLPushErrorHandlerEx(&GdalSession::collect, this);
}

GdalSession::~GdalSession() { CPLPopErrorHandler(); }

void CPL_STDCALL GdalSession::collect(CPLErr level, CPLErrorNum, const char* text) {
  auto* session = static_cast<GdalSession*>(CPLGetErrorHandlerUserData());
  if (level < CE_Warning) return;
  auto& lines = level == CE_Warning ? session->warnings_ : session->errors_;
  std::string line = one_line(text);
  if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(std::move(line));
}

std::string GdalSession::reason(const std::string& otherwise) const {
  return errors_.empty() || is_riddle(errors_.front()) ? otherwise : errors_.front();
}

GdalOption::GdalOption(const char* name, const char* value) : name_(name) {
  if (const char* before = CPLGetThreadLocalConfigOption(name, nullptr)) before_ = before;
  CPLSetThreadLocalConfigOption(name, value);
}

GdalOption::~GdalOption() { CPLSetThreadLocalConfigOption(name_, before_ ? before_->c_str() : nullptr); }

}  // namespace scarp
