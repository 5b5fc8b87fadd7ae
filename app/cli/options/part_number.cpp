// SPDX-License-Identifier: MIT
#include "app/cli/options/part_number.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "app/options/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

// Names of environment variables; empty: the scheduler has none.
struct JobArray {
  const char *index, *first, *last, *step, *count;
};
// AWS counts from 0. PBS states no last task, only the number of tasks.
constexpr JobArray kArrays[] = {
    {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX", "SLURM_ARRAY_TASK_STEP",
     "SLURM_ARRAY_TASK_COUNT"},
    {"AWS_BATCH_JOB_ARRAY_INDEX", "", "", "", "AWS_BATCH_JOB_ARRAY_SIZE"},
    {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE", ""},
    {"PBS_ARRAY_INDEX", "", "", "", "PBS_ARRAY_SIZE"},
};

// nullopt if the variable is not set. Grid Engine sets "undefined" outside of arrays.
std::optional<long> variable(const char* name) {
  const char* const text = *name != 0 ? std::getenv(name) : nullptr;
  if (!text || *text == 0 || std::string_view(text) == "undefined") return {};
  char* end = nullptr;
  const long value = std::strtol(text, &end, 10);
  if (*end != 0 || value < 0 || value > std::numeric_limits<int>::max())
    throw Error(fmt::format("--part auto: {}='{}' is not a task number", name, text));
  return value;
}

}  // namespace

PartNumber part_from(const std::string& text) {
  constexpr std::string_view kForm = "I/N, whole numbers with 1 <= I <= N, for example 3/16, or auto";
  const auto n = numbers_from(text, '/', 2, 2, "--part", kForm);
  if (!(n[0] >= 1 && n[0] <= n[1] && n[1] <= std::numeric_limits<int>::max() && n[0] == std::floor(n[0]) &&
        n[1] == std::floor(n[1])))
    throw Error(fmt::format("--part '{}': expected {}", text, kForm));
  return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

std::string part_of_job_array() {
  for (const JobArray& array : kArrays) {
    const auto index = variable(array.index);
    if (!index) continue;
    const bool from_zero = std::string_view(array.index).starts_with("AWS");
    const long first = variable(array.first).value_or(from_zero ? 0 : 1), step = variable(array.step).value_or(1);
    std::optional<long> count = variable(array.count);
    if (const auto last = variable(array.last); !count && last && step > 0) count = (*last - first) / step + 1;
    if (!count)
      throw Error(fmt::format("--part auto: {} is set, but not the number of tasks{} (give --part I/N)", array.index,
                              *array.count != 0 ? fmt::format(", {}", array.count) : ""));
    const long part = step > 0 ? (*index - first) / step + 1 : 0;
    if (step <= 0 || *index < first || (*index - first) % step != 0 || part > *count)
      throw Error(fmt::format("--part auto: {}={} is not one of {} tasks from {} in steps of {}", array.index, *index,
                              *count, first, step));
    return fmt::format("{}/{}", part, *count);
  }
  throw Error("--part auto: this is not a task of a job array (give --part I/N)");
}

}  // namespace scarp::cli
