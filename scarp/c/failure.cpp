// SPDX-License-Identifier: MIT
#include "scarp/c/failure.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace scarp::c {
namespace {

// An array, so that a message about memory needs none and nothing is destroyed when a thread ends.
thread_local std::array<char, 512> last_message{};

}  // namespace

scarp_status fail(scarp_status status, std::string_view message) noexcept {
  const std::size_t length = std::min(message.size(), last_message.size() - 1);
  std::memmove(last_message.data(), message.data(), length);
  last_message[length] = '\0';
  return status;
}

scarp_status fail_by_exception() noexcept {
  try {
    throw;
  } catch (const Unsupported& error) {
    return fail(SCARP_UNSUPPORTED, error.what());
  } catch (const Error& error) {
    return fail(SCARP_REFUSED, error.what());
  } catch (const std::bad_alloc&) {
    return fail(SCARP_NO_MEMORY, "memory: not enough is free");
  } catch (const std::length_error&) {
    return fail(SCARP_NO_MEMORY, "memory: more is asked for than can exist");
  } catch (const std::exception& error) {
    return fail(SCARP_FAILED, error.what());
  } catch (...) {
    return fail(SCARP_FAILED, "an exception of unknown type");
  }
}

}  // namespace scarp::c

const char* scarp_last_error(void) { return scarp::c::last_message.data(); }
