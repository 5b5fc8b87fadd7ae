// SPDX-License-Identifier: MIT
// A height field that can be edited while other threads query it. Queries and edits alternate on one field; an edit
// copies its samples into it.
//
//   reader  --[ epoch 7 ]------[ epoch 7 ]--------------[ epoch 8 ]---
//   reader  ----[ epoch 7 ]----------------              [ epoch 8 ]--
//   edit                          waits  [ copy, update ]
//
// A reader holds a Reading as long as its queries must see one state of the field: for a ray, a batch or a frame. The
// epoch of a state is the number of edits before it. An edit waits for current readings, and later readings wait for
// the edit, so neither side starves. An edit blocks readers while it copies its samples and updates the pyramid over
// them: 0.2 to 0.3 ms for 256 x 256 samples of a large field.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <shared_mutex>

#include "scarp/accel/max_pyramid.h"
#include "scarp/field/height_field.h"

namespace scarp {

class Turnstile;  // base/turnstile.h

/// A height field and its pyramid, shared by readers and editors.
class LiveField {
 public:
  /// Takes a field and builds its pyramid; `reserve` as in MaxPyramid. Afterwards only edit() may change the field.
  explicit LiveField(HeightField field, const std::optional<SampleRange>& reserve = std::nullopt);
  ~LiveField();
  LiveField(const LiveField&) = delete;
  LiveField& operator=(const LiveField&) = delete;

  /// The field at one epoch. Edits wait while a Reading exists. A thread that holds one must not call edit() or read():
  /// it would wait for itself.
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

  /// Returns a Reading of the current state. Waits for edits that run or already wait. Thread-safe.
  Reading read() const { return Reading(*this); }

  /// Sets samples and updates the pyramid in one step for all readers; returns the new epoch. Thread-safe. Throws Error
  /// as HeightField::set_samples() does, and then changes nothing.
  template <class T>
  std::uint64_t edit(const SampleRect& rect, const T* samples, std::ptrdiff_t stride);

 private:
  HeightField field_;
  MaxPyramid pyramid_;
  std::uint64_t epoch_ = 0;
  std::unique_ptr<Turnstile> turnstile_;
};

}  // namespace scarp
