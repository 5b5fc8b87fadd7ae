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

constexpr std::string_view kPartForm = "I/N, whole numbers with 1 <= I <= N, for example 3/16, or auto, or auto/N";

// Names of environment variables; empty: the scheduler has none.
struct JobArray {
  const char *index, *first, *last, *step, *count;

  bool from_zero() const { return std::string_view(index).starts_with("AWS"); }
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
  const auto n = numbers_from(text, '/', 2, 2, "--part", kPartForm);
  if (!(n[0] >= 1 && n[0] <= n[1] && n[1] <= std::numeric_limits<int>::max() && n[0] == std::floor(n[0]) &&
        n[1] == std::floor(n[1])))
    throw Error(fmt::format("--part '{}': expected {}", text, kPartForm));
  return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

namespace {

// "7" of "auto/7"; nullopt for "auto".
std::optional<long> parts_typed(const std::string& text) {
  if (text == kAutomaticPart) return {};
  const std::string count = text.substr(kAutomaticPart.size() + 1);
  char* end = nullptr;
  const long parts = std::strtol(count.c_str(), &end, 10);
  if (count.empty() || *end != 0 || parts < 1 || parts > std::numeric_limits<int>::max())
    throw Error(fmt::format("--part '{}': expected {}", text, kPartForm));
  return parts;
}

// The task of an array of some other size: the one that failed in an array of `parts` tasks, run again.
std::string part_of_again(const JobArray& array, long index, long parts) {
  const long part = index + (array.from_zero() ? 1 : 0);
  if (part < 1 || part > parts)
    throw Error(fmt::format("--part auto/{}: {}={} is not a task from {} to {}", parts, array.index, index,
                            array.from_zero() ? 0 : 1, array.from_zero() ? parts - 1 : parts));
  return fmt::format("{}/{}", part, parts);
}

std::string part_of_all(const JobArray& array, long index) {
  const auto typed_first = variable(array.first), last = variable(array.last);
  const long first = typed_first.value_or(array.from_zero() ? 0 : 1), step = variable(array.step).value_or(1);
  std::optional<long> count = variable(array.count);
  if (!count && last && step > 0) count = (*last - first) / step + 1;
  if (!count)
    throw Error(fmt::format("--part auto: {} is set, but not the number of tasks{} (give --part I/N or auto/N)",
                            array.index, *array.count != 0 ? fmt::format(", {}", array.count) : ""));
  // Tasks that are run again look like an array of their own, and would compute other rows.
  const bool has_gaps = last && step > 0 && (*last - first) / step + 1 != *count;
  if (first > 1 || has_gaps)
    throw Error(
        fmt::format("--part auto: the array has {} task{} from {}{}: a part of another array? (give --part "
                    "auto/N for N parts, with tasks from 1 to N)",
                    *count, *count == 1 ? "" : "s", first, has_gaps ? ", with gaps" : ""));
  const long part = step > 0 ? (index - first) / step + 1 : 0;
  if (step <= 0 || index < first || (index - first) % step != 0 || part > *count)
    throw Error(fmt::format("--part auto: {}={} is not one of {} tasks from {} in steps of {}", array.index, index,
                            *count, first, step));
  return fmt::format("{}/{}", part, *count);
}

}  // namespace

bool is_automatic_part(std::string_view text) {
  return text == kAutomaticPart || text.starts_with(fmt::format("{}/", kAutomaticPart));
}

std::string part_of_job_array(const std::string& text) {
  const auto parts = parts_typed(text);
  for (const JobArray& array : kArrays)
    if (const auto index = variable(array.index))
      return parts ? part_of_again(array, *index, *parts) : part_of_all(array, *index);
  throw Error(fmt::format("--part {}: this is not a task of a job array (give --part I/N)", text));
}

}  // namespace scarp::cli
