// SPDX-License-Identifier: MIT
// Results of `scarp render` besides the picture.
#pragma once

#include <nlohmann/json.hpp>

#include "scarp/render/frame/picture.h"

namespace scarp::cli {

/// Prints steps, reads, heights or verdicts, depending on the look.
void print_findings(const Picture& picture);

/// The same as JSON: members "steps", "cost", "heights_m" and "errors", each only if the look has it.
nlohmann::ordered_json describe_findings(const Picture& picture);

}  // namespace scarp::cli
