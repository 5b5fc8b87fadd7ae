// SPDX-License-Identifier: MIT
#include "app/cli/mesh_options.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

#include "app/cli/numbers.h"
#include "scarp/base/error.h"
#include "scarp/source/mesh_file.h"
#ifdef SCARP_VULKAN
#include "scarp/render/frame/mesh_picture_vk.h"
#endif

namespace scarp::cli {

void add_mesh_options(CLI::App& command, MeshOptions& options) {
  const std::string group = "Mesh";
  command.add_option("--mesh", options.file, "a triangle mesh, .obj, .gltf or .glb, among the terrain; needs --device")
      ->group(group);
  command
      .add_option(
          "--mesh-at", options.at,
          "X,Y[,Z] in metres, as --eye: where its middle, seen from above, and its lowest point are (the middle "
          "of the field; on the ground)")
      ->group(group);
  command.add_option("--mesh-scale", options.scale, "metres per unit of the file, above 0")
      ->check(number_in(kAboveZero))
      ->group(group)
      ->capture_default_str();
  command.add_option("--mesh-rotate", options.turn_deg, "degrees clockwise, seen from above")
      ->check(number_in(kAnyNumber))
      ->group(group)
      ->capture_default_str();
  command.add_option("--mesh-up", options.up, "the axis that points up in the file, y or z")
      ->group(group)
      ->capture_default_str();
}

void settle_mesh(const MeshOptions& options, const std::string& device, const PictureSettings& picture) {
  if (options.file.empty()) return;
#ifndef SCARP_VULKAN
  throw Error("--mesh: this scarp was built without Vulkan (SCARP_VULKAN=OFF); leave it out");
#endif
  if (device.empty()) throw Error("--mesh: is drawn by a Vulkan device; add --device auto ('scarp devices')");
  if (picture.look != Look::shaded)
    throw Error(fmt::format("--mesh: goes with the look shaded, not with '{}'", name_of(picture.look)));
  if (picture.water) throw Error("--mesh: is not reflected by --water; leave one of both out");
  if (options.up != "y" && options.up != "z") throw Error(fmt::format("--mesh-up '{}': expected y or z", options.up));
}

#ifdef SCARP_VULKAN

struct MeshInput::Impl {
  TriangleMesh mesh;
  std::optional<dvec2> at;
  std::optional<double> height;
  double scale, turn_deg;
  std::optional<MeshRaster> raster;
};

MeshInput::MeshInput(const MeshOptions& options) {
  if (options.file.empty()) return;
  std::optional<dvec2> at;
  std::optional<double> height;
  if (!options.at.empty()) {
    const auto numbers =
        numbers_from(options.at, ',', 2, 3, "--mesh-at",
                     "X,Y or X,Y,Z in metres from the south-west sample, for example 500,300 or 500,300,1200");
    at = dvec2(numbers[0], numbers[1]);
    if (numbers.size() > 2) height = numbers[2];
  }
  impl_.reset(new Impl{read_mesh(options.file, options.up == "z" ? MeshUp::z : MeshUp::y),
                       at,
                       height,
                       options.scale,
                       options.turn_deg,
                       {}});
}

void MeshInput::stand_on(const TerrainScene& scene) {
  if (!impl_) return;
  const HeightField& field = scene.field();
  const dvec2 at = impl_->at.value_or(dvec2(field.width() / 2, field.depth() / 2));
  if (!impl_->height) impl_->height = field.height(at.x, at.y);
  if (!impl_->height) {
    throw Error(fmt::format(
        "--mesh-at: there is no ground at {:g},{:g} for the mesh to stand on; the field is {:g} x {:g} m, give X,Y,Z",
        at.x, at.y, field.width(), field.depth()));
  }
  impl_->raster.emplace(scene, placed(impl_->mesh, {dvec3(at.x, at.y, *impl_->height), impl_->scale, impl_->turn_deg}));
}

Picture MeshInput::picture(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                           const PictureSettings& settings, const Progress& progress) {
  if (!impl_) return render_picture(scene, camera, grid_north_azimuth, settings, progress);
  return render_with_mesh(scene, *impl_->raster, camera, grid_north_azimuth, settings, progress);
}

PictureLayers MeshInput::layers(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                                const PictureSettings& settings, const Progress& progress) {
  if (!impl_) return render_layers(scene, camera, grid_north_azimuth, settings, progress);
  return render_layers_with_mesh(scene, *impl_->raster, camera, grid_north_azimuth, settings, progress);
}

const std::vector<std::string>& MeshInput::notes() const {
  static const std::vector<std::string> none;
  return impl_ ? impl_->mesh.notes : none;
}

#else

// settle_mesh has refused all meshes.
struct MeshInput::Impl {};
MeshInput::MeshInput(const MeshOptions&) {}
void MeshInput::stand_on(const TerrainScene&) {}
Picture MeshInput::picture(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                           const PictureSettings& settings, const Progress& progress) {
  return render_picture(scene, camera, grid_north_azimuth, settings, progress);
}
PictureLayers MeshInput::layers(const TerrainScene& scene, const Camera& camera, double grid_north_azimuth,
                                const PictureSettings& settings, const Progress& progress) {
  return render_layers(scene, camera, grid_north_azimuth, settings, progress);
}
const std::vector<std::string>& MeshInput::notes() const {
  static const std::vector<std::string> none;
  return none;
}

#endif

MeshInput::~MeshInput() = default;

}  // namespace scarp::cli
