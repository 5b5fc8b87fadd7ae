// SPDX-License-Identifier: MIT
// A height field that is edited while others ask it: queries and edits take turns, nothing is copied.
//
//   reader  --[ epoch 7 ]------[ epoch 7 ]--------------[ epoch 8 ]---
//   reader  ----[ epoch 7 ]----------------              [ epoch 8 ]--
//   edit                          waits  [ copy, update ]
//
// A reader holds a Reading for as long as its answers have to agree: a ray, a batch, a frame. All that it asks
// meanwhile sees one epoch of the field. An edit waits for the readings that are held, and readings that come after it
// wait for the edit: neither side starves the other. What an edit holds up is the copy of its samples and the update of
// the pyramid over them, about 0.1 to 0.2 ms for 256 x 256 samples of a large field.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <shared_mutex>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"

namespace scarp {

class LiveField {
 public:
  /// Builds the pyramid; `reserve` as there. Field and samples must not be changed in any other way afterwards.
  explicit LiveField(HeightField field, const std::optional<SampleRange>& reserve = std::nullopt);

  /// The field as it is at one epoch. Edits wait while it lives: a thread that holds one must not edit, nor
  /// take another, which would wait for an edit that waits for the first.
  class Reading {
   public:
    const HeightField& field() const { return live_->field_; }
    const MaxPyramid& pyramid() const { return live_->pyramid_; }
    std::uint64_t epoch() const { return live_->epoch_; }

   private:
    friend class LiveField;
    explicit Reading(const LiveField& live);
    const LiveField* live_;
    std::shared_lock<std::shared_mutex> held_;
  };

  /// May be called from any thread; waits for an edit that runs or waits.
  Reading read() const { return Reading(*this); }

  /// HeightField::set_samples and the update of the pyramid, as one step for all readers; returns the new epoch. May be
  /// called from any thread. Throws Error as set_samples() does, and changes nothing then.
  template <class T>
  std::uint64_t edit(const SampleRect& rect, const T* samples, std::ptrdiff_t stride);

 private:
  HeightField field_;
  MaxPyramid pyramid_;
  std::uint64_t epoch_ = 0;
  mutable std::mutex turnstile_;  // held by an edit from the moment it waits: readings that come later queue here
  mutable std::shared_mutex held_;
};

}  // namespace scarp
