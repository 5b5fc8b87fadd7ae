// SPDX-License-Identifier: MIT
// GDAL talks to stderr; Scarp says one line. While a GdalSession lives, GDAL's messages of this thread are collected.
#pragma once

#include <cpl_error.h>

#include <optional>
#include <string>
#include <vector>

namespace scarp {

/// Registers GDAL's drivers (once per process) and collects its messages; put on the stack around calls of GDAL.
class GdalSession {
 public:
  GdalSession();
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  /// Whether an error (not a warning) came since the last clear().
  bool failed() const { return !errors_.empty(); }
  /// The first error in one line (the later ones only repeat it from farther away), or `otherwise` when GDAL gave none
  /// that says something to people.
  std::string reason(const std::string& otherwise) const;
  /// The different warnings, in one line each.
  const std::vector<std::string>& warnings() const { return warnings_; }
  void clear() { errors_.clear(); }

 private:
  static void CPL_STDCALL collect(CPLErr level, CPLErrorNum number, const char* text);
  std::vector<std::string> errors_;
  std::vector<std::string> warnings_;
};

/// Sets one of GDAL's configuration options for this thread while it lives.
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
