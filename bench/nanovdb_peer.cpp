// SPDX-License-Identifier: MIT
#include "bench/nanovdb_peer.h"

#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/HDDA.h>
#include <nanovdb/util/Ray.h>

#include <utility>

namespace scarp::bench {
namespace {

using NanoRay = nanovdb::Ray<float>;

}  // namespace

struct NanovdbPeer::Tree {
  nanovdb::GridHandle<> handle;
};

NanovdbPeer::NanovdbPeer(const VoxelGrid& grid)
    : NanovdbPeer([&](const Set& set) {
        for_each_voxel(grid.bounds(), [&](const ivec3& v) {
          if (grid.solid(v)) set(v, static_cast<float>(grid.entry(v)));
        });
      }) {}

NanovdbPeer::NanovdbPeer(const std::function<void(const Set&)>& fill) : tree_(std::make_unique<Tree>()) {
  nanovdb::GridBuilder<float> builder(0.0f);
  auto to = builder.getAccessor();
  fill([&](const ivec3& v, float value) { to.setValue(nanovdb::Coord(v.x, v.y, v.z), value); });
  tree_->handle = builder.getHandle<>();
}
NanovdbPeer::NanovdbPeer(NanovdbPeer&&) noexcept = default;
NanovdbPeer::~NanovdbPeer() = default;

std::vector<VoxelEngine> NanovdbPeer::engines() const {
  return {engine("push 1.0001", 1.0001f), engine("push 0.0001", 0.0001f)};
}

VoxelEngine NanovdbPeer::engine(const char* mode, float push) const {
  VoxelEngine engine;
  engine.name = "nanovdb-hdda", engine.mode = mode, engine.box = "bounds";
  engine.mib = static_cast<double>(tree_->handle.size()) / (1 << 20);
  engine.trace = [&handle = tree_->handle, push](std::span<const Ray> rays, std::span<Hit> hits) {
    const nanovdb::NanoGrid<float>* grid = handle.grid<float>();
    const auto box = grid->tree().root().bbox();
    auto accessor = grid->getAccessor();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const dvec3 &o = rays[i].origin, &d = rays[i].direction;
      const auto f = [](double x) { return static_cast<float>(x); };
      NanoRay ray(nanovdb::Vec3<float>(f(o.x), f(o.y), f(o.z)), nanovdb::Vec3<float>(f(d.x), f(d.y), f(d.z)), 0.0f);
      Hit& to = hits[i];
      to = {};
      if (!ray.clip(box)) continue;
      // Steps from active node to active voxel, as NanoVDB's ZeroCrossing() does to find the first active voxel.
      nanovdb::Coord at = nanovdb::RoundDown<nanovdb::Coord>(ray.start());
      float t = ray.t0();
      nanovdb::HDDA<NanoRay, nanovdb::Coord> walk(ray, accessor.getDim(at, ray));
      bool inside = true;
      while (!accessor.isActive(at) && (inside = walk.step())) {
        t = walk.time();
        at = nanovdb::RoundDown<nanovdb::Coord>(ray(t + push));
        walk.update(ray, accessor.getDim(at, ray));
      }
      if (!inside) continue;
      to.status = HitStatus::hit, to.t = static_cast<double>(t), to.voxel = {at[0], at[1], at[2]};
    }
  };
  return engine;
}

}  // namespace scarp::bench
