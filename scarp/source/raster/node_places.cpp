// SPDX-License-Identifier: MIT
#include "scarp/source/raster/node_places.h"

#include <fmt/format.h>

#include <utility>

#include "scarp/base/error.h"

namespace scarp {

// A frame borrowed for one call; one exists per concurrent call.
class NodePlaces::Borrowed {
 public:
  explicit Borrowed(const NodePlaces& owner) : owner_(owner) {
    {
      const std::lock_guard lock(owner.mutex_);
      if (!owner.free_.empty()) {
        frame_ = std::move(owner.free_.back());
        owner.free_.pop_back();
      }
    }
    if (!frame_)
      frame_ = std::make_unique<CoordinateFrame>(owner.georeference_, owner.cols_, owner.rows_, Coordinates::lonlat);
  }
  ~Borrowed() {
    const std::lock_guard lock(owner_.mutex_);
    owner_.free_.push_back(std::move(frame_));
  }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;

  const CoordinateFrame& operator*() const { return *frame_; }

 private:
  const NodePlaces& owner_;
  std::unique_ptr<CoordinateFrame> frame_;
};

NodePlaces::NodePlaces(const Georeference& georeference, int cols, int rows)
    : georeference_(georeference), cols_(cols), rows_(rows) {
  const Borrowed first(*this);  // throws the frame's errors here, not in row()
}

NodePlaces::~NodePlaces() = default;

void NodePlaces::row(int row, int first_col, std::span<dvec3> places) const {
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = {(first_col + static_cast<double>(i)) * georeference_.cell_x_m,
                 (rows_ - 1.0 - row) * georeference_.cell_y_m, 0};
  if (const auto failed = (*Borrowed(*this)).from_local(places))
    throw Error(fmt::format("column {}, row {} is outside the domain of the raster's CRS",
                            first_col + static_cast<int>(*failed), row));
}

}  // namespace scarp
