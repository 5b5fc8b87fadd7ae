// SPDX-License-Identifier: MIT
// The error of a rejected call.
#pragma once

#include <string>

#include "scarp/base/error.h"

namespace scarp::test {

/// The text of the Error that `act` throws; empty when it throws none.
template <class Act>
std::string refusal(const Act& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace scarp::test
