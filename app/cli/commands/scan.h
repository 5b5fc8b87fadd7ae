// SPDX-License-Identifier: MIT
// `scarp cast --scanner`: the points that a scanner measures in a scene.
#pragma once

#include <string>
#include <vector>

#include "app/cli/options/places.h"
#include "app/options/command.h"
#include "scarp/base/georeference.h"
#include "scarp/scene/file/scanner_file.h"
#include "scarp/scene/scene.h"

namespace scarp::cli {

/// Typed options.
struct ScanOptions {
  std::string scanner;
  bool misses = false;
};

void add_scan_options(Command& command, ScanOptions& options);

/// Throws Error if the extension of the output is not that of a point file, or the file cannot hold misses.
void check_scan_output(const ScanOptions& options, const std::string& output);

/// The input of a scan.
struct ScannedScene {
  const Scene& scene;
  const Places& places;
  const Georeference& georeference;
};

/// Writes the points of a scan to `output`; empty: CSV to standard output. Prints `notes` and further notes when the
/// file is complete. Throws Interrupted after a signal.
void run_scan(const ScanOptions& options, ScannerFile scanner, const ScannedScene& scanned, const std::string& output,
              const std::vector<std::string>& notes, const std::string& device);

}  // namespace scarp::cli
