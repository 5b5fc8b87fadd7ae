// SPDX-License-Identifier: MIT
// Collects GDAL's messages, which would otherwise go to stderr.
#pragma once

#include <cpl_error.h>

#include <optional>
#include <string>
#include <vector>

namespace scarp {

/// Registers GDAL's drivers (once per process) and collects GDAL's messages on this thread during its lifetime. Place
/// one on the stack around calls to GDAL.
class GdalSession {
 public:
  GdalSession();
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  /// Returns whether an error (not a warning) occurred since the last clear().
  bool failed() const { return !errors_.empty(); }
  /// Returns the first error in one line (later ones are consequences), or `otherwise` if GDAL reported no error that
  /// users would understand.
  std::string reason(const std::string& otherwise) const;
  /// Returns the distinct warnings, one line each.
  const std::vector<std::string>& warnings() const { return warnings_; }
  void clear() { errors_.clear(); }

 private:
  static void CPL_STDCALL collect(CPLErr level, CPLErrorNum number, const char* text);
  std::vector<std::string> errors_;
  std::vector<std::string> warnings_;
};

/// Sets a GDAL configuration option for this thread during its lifetime.
class GdalOption {
 public:
  GdalOption(const char* name, const char* value);
  ~GdalOption();
  GdalOption(const GdalOption&) = delete;
  GdalOption& operator=(const GdalOption&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

}  // namespace scarp
