// SPDX-License-Identifier: MIT
#include "scarp/base/edit_count.h"

namespace scarp {

std::atomic<std::uint64_t> edits_of_all_fields{0};

}  // namespace scarp
