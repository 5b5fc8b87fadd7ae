// SPDX-License-Identifier: MIT
#include "scarp/accel/live_field.h"

#include <utility>

#include "scarp/base/turnstile.h"

namespace scarp {

LiveField::LiveField(HeightField field, const std::optional<SampleRange>& reserve)
    : field_(std::move(field)), pyramid_(field_, reserve), turnstile_(std::make_unique<Turnstile>()) {}
LiveField::~LiveField() = default;

LiveField::Reading::Reading(const LiveField& live) : live_(&live), held_(live.turnstile_->read()) {}

template <class T>
std::uint64_t LiveField::edit(const SampleRect& rect, const T* samples, std::ptrdiff_t stride) {
  const auto alone = turnstile_->edit();
  pyramid_.update(field_, field_.set_samples(rect, samples, stride));
  return ++epoch_;
}

#define SCARP_INSTANTIATE(T) template std::uint64_t LiveField::edit(const SampleRect&, const T*, std::ptrdiff_t);
SCARP_INSTANTIATE(std::int16_t)
SCARP_INSTANTIATE(std::uint16_t)
SCARP_INSTANTIATE(float)
#undef SCARP_INSTANTIATE

}  // namespace scarp
