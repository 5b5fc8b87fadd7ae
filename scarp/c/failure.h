// SPDX-License-Identifier: MIT
// From C++ exceptions to a status and a message per thread.
#pragma once

#include <fmt/format.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/scarp_c.h"

namespace scarp::c {

/// Thrown for queries that a scene does not have.
class Unsupported : public Error {
 public:
  using Error::Error;
};

/// Keeps the message for scarp_last_error() and returns the status. Allocates nothing; long messages are cut.
scarp_status fail(scarp_status status, std::string_view message) noexcept;
/// fail() with the exception that is being handled.
scarp_status fail_by_exception() noexcept;

/// Calls body() and returns SCARP_OK, or the status of what it throws.
template <class Body>
scarp_status guarded(const Body& body) noexcept {
  try {
    body();
    return SCARP_OK;
  } catch (...) {
    return fail_by_exception();
  }
}

/// Throws Error if the pointer is null.
template <class T>
T& required(T* pointer, const char* name) {
  if (!pointer) throw Error(fmt::format("{}: is NULL", name));
  return *pointer;
}
/// The same for an array, which may be null if it is empty.
template <class T>
T* required(T* pointer, std::size_t count, const char* name) {
  if (!pointer && count > 0) throw Error(fmt::format("{}: is NULL, but {} elements are asked for", name, count));
  return pointer;
}

}  // namespace scarp::c
