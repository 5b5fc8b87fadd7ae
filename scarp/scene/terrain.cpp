// SPDX-License-Identifier: MIT
#include "scarp/scene/terrain.h"

#include <utility>

namespace scarp {

// The field of the scene shares samples and levels with `field` and `pyramid`.
struct Terrain::State {
  HeightField field;
  Georeference georeference;
  MaxPyramid pyramid{field};
  CellMaterials materials{};
  Scene scene{scene_heights(field, pyramid)};
};

Terrain::Terrain(HeightField field, Georeference georeference)
    : state_(std::make_shared<State>(State{std::move(field), std::move(georeference)})) {}

template <class T>
Terrain Terrain::view(const T* samples, int cols, int rows, const HeightFieldSettings& settings,
                      std::ptrdiff_t row_stride, std::weak_ptr<const void> memory) {
  return Terrain(HeightField::view(samples, cols, rows, settings, row_stride, std::move(memory)));
}

template <class T>
Terrain Terrain::own(std::vector<T> samples, int cols, int rows, const HeightFieldSettings& settings) {
  return Terrain(HeightField::own(std::move(samples), cols, rows, settings));
}

template <class T>
void Terrain::set_samples(const SampleRect& rect, const T* samples, std::ptrdiff_t row_stride) {
  changed(state_->field.set_samples(rect, samples, row_stride == 0 ? rect.cols : row_stride));
}

void Terrain::samples_changed(const SampleRect& rect) { changed(state_->field.samples_changed(rect)); }

void Terrain::set_materials(std::vector<std::uint8_t> materials) {
  CellMaterials shared;
  if (!materials.empty()) shared = std::make_shared<const std::vector<std::uint8_t>>(std::move(materials));
  require_materials(field(), shared);
  state_->scene = Scene(scene_heights(field(), pyramid(), shared));
  state_->materials = std::move(shared);
}

void Terrain::changed(const CellBox& cells) {
  state_->pyramid.update(state_->field, cells);
  // The scene's box still reflects the old heights.
  state_->scene = Scene(state_->scene.fields()[0]);
}

const HeightField& Terrain::field() const { return state_->field; }
const MaxPyramid& Terrain::pyramid() const { return state_->pyramid; }
const Georeference& Terrain::georeference() const { return state_->georeference; }
const Scene& Terrain::scene() const { return state_->scene; }

#define SCARP_INSTANTIATE(T)                                                                        \
  template Terrain Terrain::view<T>(const T*, int, int, const HeightFieldSettings&, std::ptrdiff_t, \
                                    std::weak_ptr<const void>);                                     \
  template Terrain Terrain::own<T>(std::vector<T>, int, int, const HeightFieldSettings&);           \
  template void Terrain::set_samples<T>(const SampleRect&, const T*, std::ptrdiff_t);
SCARP_INSTANTIATE(std::int16_t)
SCARP_INSTANTIATE(std::uint16_t)
SCARP_INSTANTIATE(float)
#undef SCARP_INSTANTIATE

}  // namespace scarp
