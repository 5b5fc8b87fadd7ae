// SPDX-License-Identifier: MIT
// --part I/N: the share of a task in a map.
#pragma once

#include <string>
#include <string_view>

namespace scarp::cli {

/// Value of --part for the task of a job array.
inline constexpr std::string_view kAutomaticPart = "auto";
/// Whether a value of --part is "auto", or "auto/..." with the number of parts.
bool is_automatic_part(std::string_view text);

struct PartNumber {
  int part = 1, parts = 1;  ///< 1 <= part <= parts
};

/// Throws Error for a text that is not I/N.
PartNumber part_from(const std::string& text);

/// Returns "I/N" from the variables that SLURM, AWS Batch, PBS and Grid Engine set for the tasks of job arrays. `text`:
/// "auto", or "auto/N" for N parts, whatever the size of the array: its tasks count from 1, of AWS from 0. Throws Error
/// if there are no variables, and for "auto" if they state no size, or if the array does not begin at 0 or 1 or has
/// gaps, like tasks that are run again.
std::string part_of_job_array(const std::string& text = std::string(kAutomaticPart));

}  // namespace scarp::cli
