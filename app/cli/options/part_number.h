// SPDX-License-Identifier: MIT
// --part I/N: the share of a task in a map.
#pragma once

#include <string>
#include <string_view>

namespace scarp::cli {

/// Value of --part for the task of a job array.
inline constexpr std::string_view kAutomaticPart = "auto";

struct PartNumber {
  int part = 1, parts = 1;  ///< 1 <= part <= parts
};

/// Throws Error for a text that is not I/N.
PartNumber part_from(const std::string& text);

/// Returns "I/N" from the variables that SLURM, AWS Batch, PBS and Grid Engine set for the tasks of job arrays. Throws
/// Error if there are none, or if they state no size.
std::string part_of_job_array();

}  // namespace scarp::cli
