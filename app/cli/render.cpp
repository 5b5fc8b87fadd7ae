// SPDX-License-Identifier: MIT
// `scarp render`: an elevation model, a voxel model or a scene in, a picture out.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/depth_options.h"
#include "app/cli/device_option.h"
#include "app/cli/exr_output.h"
#include "app/cli/field_options.h"
#include "app/cli/figure_options.h"
#include "app/cli/findings.h"
#include "app/cli/frames.h"
#include "app/cli/function_input.h"
#include "app/cli/input_kind.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/look_options.h"
#include "app/cli/march_options.h"
#include "app/cli/mesh_options.h"
#include "app/cli/numbers.h"
#include "app/cli/progress.h"
#include "app/cli/raster_options.h"
#include "app/cli/scene_input.h"
#include "app/cli/vox_input.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/output/png.h"
#include "scarp/render/camera/field_view.h"
#include "scarp/render/frame/picture.h"
#include "scarp/render/surface/ramp.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/scene/file/from_vox.h"
#include "scarp/source/read_raster.h"

namespace scarp::cli {
namespace {

constexpr const char* kTerrainMarch = "max-mip";  // without --march

// What was typed. Texts stay texts until run() has a message for them.
struct RenderOptions {
  std::vector<std::string> inputs;
  std::string output;
  RasterOptions raster;
  FieldOptions field;
  VoxOptions vox;
  VoxLookOptions vox_look;
  FunctionInput function;
  std::string march;  // empty: the fastest exact one
  std::string device;
  MarchSettings march_settings;
  PictureSettings picture;
  LookOptions look_options;
  FrameOptions frames;
  DepthOptions depth;
  FigureOptions figure;
  MeshOptions mesh;
  std::string size, look = "shaded", sun, view, eye, target;
  bool exr = false;
  double fov_deg = ViewSettings{}.fov_deg;
  bool fov_said = false, top = false, no_shadows = false, no_plinth = false;
  int threads = 0;
  std::vector<std::string> given;  // the names of the options that were typed
  std::vector<std::string> typed;  // and their values
};

// Seconds since it was made or last asked.
class Watch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(begin_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

int whole(double number, const RenderOptions& options) {
  if (number != std::floor(number) || std::abs(number) > 1e9) {
    throw Error(fmt::format("--size '{}': expected WIDTHxHEIGHT in pixels, for example 1280x720", options.size));
  }
  return static_cast<int>(number);
}

dvec3 point_from(const std::string& text, std::string_view option) {
  const auto p =
      numbers_from(text, ',', 3, 3, option, "X,Y,Z in metres from the south-west sample, for example 500,-2000,1800");
  return {p[0], p[1], p[2]};
}

// The texts become settings; all that can be judged without the file is judged here.
ViewSettings settle(RenderOptions& options) {
  PictureSettings& picture = options.picture;
  picture.look = find_look(options.look);
  picture.shadows = !options.no_shadows;
  picture.plinth = !options.no_plinth;
  settle_look(options.look_options, options.size, options.march, options.march_settings, picture);
  if (!options.size.empty()) {
    const auto size = numbers_from(options.size, 'x', 2, 2, "--size", "WIDTHxHEIGHT in pixels, for example 1280x720");
    picture.width = whole(size[0], options);
    picture.height = whole(size[1], options);
  }
  if (!options.sun.empty()) {
    const auto sun = numbers_from(options.sun, ',', 2, 2, "--sun", "AZIMUTH,ALTITUDE in degrees, for example 315,45");
    picture.sun.azimuth_deg = sun[0];
    picture.sun.altitude_deg = sun[1];
  }
  validate(picture);
  if (picture.look == Look::comanche && !options.fov_said) options.fov_deg = 60;
  ViewSettings view;
  view.fov_deg = options.fov_deg;
  if (!options.view.empty()) {
    const auto numbers = numbers_from(options.view, ',', 2, 3, "--view",
                                      "AZIMUTH,ELEVATION[,DISTANCE] in degrees and multiples of the framed distance, "
                                      "for example 205,35 or 205,35,0.5");
    view.azimuth_deg = numbers[0];
    view.elevation_deg = numbers[1];
    if (numbers.size() == 3) view.distance = numbers[2];
  }
  validate(view);
  validate(options.march_settings);
  settle_frames(options.frames, options.output);
  options.exr = extension_of(options.output) == ".exr";
  if (const auto range = depth_range_of(options.depth); range && !options.exr) {
    throw Error("--depth-range: device depth is a channel of EXR pictures; let the name of the output end in .exr");
  }
  settle_figure(options.figure, picture, options.exr);
  settle_mesh(options.mesh, options.device, picture);
  if (options.exr) {
    require_exr(options.output);
    if (picture.look != Look::shaded) {
      throw Error(
          fmt::format("--look {}: EXR holds the look 'shaded' with depth, position and steps as channels of "
                      "their own; leave --look out, or let the name of the output end in .png",
                      options.look));
    }
  } else if (!options.output.empty() && extension_of(options.output) != ".png") {
    throw Error(fmt::format("output '{}': pictures are written as PNG or EXR; let the name end in .png or .exr",
                            options.output));
  }
  return view;
}

// A map without --size has the shape of the ground, its longer side as long as a picture's default width.
void fit_size_to_ground(const Box& box, PictureSettings& picture) {
  const dvec3 size = box.high - box.low;
  const double pixels_per_metre = picture.width / std::max(size.x, size.y);
  picture.width = std::max(1, static_cast<int>(std::lround(size.x * pixels_per_metre)));
  picture.height = std::max(1, static_cast<int>(std::lround(size.y * pixels_per_metre)));
}

Camera camera_of(const RenderOptions& options, const ViewSettings& view, const Box& box, double grid_north_azimuth) {
  const int width = options.picture.width, height = options.picture.height;
  if (options.top) return Camera::top(box, width, height);
  if (options.eye.empty()) return Camera::framed(box, view, grid_north_azimuth, width, height);
  const dvec3 target = options.target.empty() ? box.middle() : point_from(options.target, "--target");
  return Camera::look_at(point_from(options.eye, "--eye"), target, options.fov_deg, width, height);
}

// `raised` becomes the most that an eye was.
Camera framed_camera(const RenderOptions& options, const ViewSettings& view, const HeightField& field, const Box& box,
                     double grid_north_azimuth, double& raised) {
  const FieldView framed =
      view_of_field(field, box, view, grid_north_azimuth, options.picture.width, options.picture.height);
  raised = std::max(raised, framed.raised);
  return framed.camera;
}

Camera terrain_camera(const RenderOptions& options, const ViewSettings& view, const HeightField& field, const Box& box,
                      double grid_north_azimuth, double& raised) {
  if (options.picture.look == Look::comanche && !options.top && options.view.empty() && options.eye.empty()) {
    return flight_camera(field, grid_north_azimuth, options.fov_deg, options.picture.width, options.picture.height);
  }
  if (options.top || !options.eye.empty()) return camera_of(options, view, box, grid_north_azimuth);
  return framed_camera(options, view, field, box, grid_north_azimuth, raised);
}

void print_times(const RenderOptions& options, double read_s, double build_s, double render_s,
                 const std::string& device = {}) {
  const int scale = options.picture.look == Look::comanche ? options.picture.comanche.scale : 1;
  fmt::print("{}: {} x {} pixels; read {:.2f} s, build {:.2f} s, render {:.2f} s{}\n", options.output,
             options.picture.width * scale, options.picture.height * scale, read_s, build_s, render_s,
             device.empty() ? "" : ", on " + device);
}

SceneDetail detail_of(const Camera& camera, int aa) {
  return {camera.eye(), camera.forward(), [&camera, aa](double depth) { return camera.pixel_width(depth) / aa; }};
}

// Writes the picture, and says what it took.
void write_scene_picture(const RenderOptions& options, ReplaceFile& file, const Scene& scene, const SceneLook& look,
                         const Camera& camera, Watch& watch, double read_s, double build_s,
                         const std::string& device = {}) {
  if (options.exr) {
    const PictureLayers layers = render_scene_layers(scene, look, camera, options.picture, terminal_progress("render"));
    const double render_s = watch.lap();
    write_layers(file, options.output, layers, camera, depth_range_of(options.depth));
    print_times(options, read_s, build_s, render_s, device);
    return;
  }
  const Picture picture = render_scene(scene, look, camera, options.picture, terminal_progress("render"));
  const double render_s = watch.lap();
  write_png(file, options.output, {picture.image.rgb.data(), picture.image.width, picture.image.height});
  print_times(options, read_s, build_s, render_s, device);
  print_findings(picture);
}

// The looks and numbers that `options` ask for, for what they have effect on.
void require_company_of(const RenderOptions& options, InputKind kind) {
  const PictureSettings& picture = options.picture;
  const bool steps = options.look == "steps";
  const LookOptions& look = options.look_options;
  require_company(
      {{{"--water-colour", "--turbidity", "--waves", "--wavelength", "--no-reflection", "--no-refraction"},
        look.water.has_value(),
        "--water M"},
       {{"--visibility", "--sun-tint"}, !look.fog.empty() && look.fog != "none", "--fog KIND"},
       {{"--fog-base", "--fog-falloff"}, look.fog == "height", "--fog height"},
       {{"--snow-line"}, look.ground_colours == "natural", "--ground natural"},
       {{"--detail-size"}, look.ground.detail > 0, "--detail S"},
       // The number may stand in the scene's file.
       {{"--sun-size", "--ao-distance", "--seed"}, picture.samples > 0 || kind == InputKind::scene, "--samples N"},
       {{"--mesh-at", "--mesh-scale", "--mesh-rotate", "--mesh-up"}, !options.mesh.file.empty(), "--mesh FILE"},
       {{"--normal-radius"}, options.vox_look.normals != "flat", "--normals voxel or smooth"},
       {{"--ramp"}, kind != InputKind::voxels || !options.vox.volume.empty() || steps, "--volume or --look steps"},
       {{"--ramp"}, kind != InputKind::scene || steps, "--look steps"}},
      options.given);
  if (!options.frames.several()) return;
  for (const std::string_view option : {"--eye", "--target", "--top"}) {
    if (is_given(options.given, option))
      throw Error(fmt::format("{}: --path and --turntable have cameras of their own; leave it out", option));
  }
  if (!options.frames.path.empty() && is_given(options.given, "--view"))
    throw Error("--view: the cameras stand in the table of --path; leave it out");
}

// Throws Error for what was typed and would have no effect.
void require_effect(const RenderOptions& options, InputKind kind) {
  require_options_of(kind, options.given);
  find_look(options.look);
  require_options_of_look(options.look, kind, options.given);
  require_company_of(options, kind);
  if (kind == InputKind::terrain) {
    require_settings_of(options.march.empty() ? kTerrainMarch : options.march, options.given, options.march_settings);
  } else if (options.look == "comanche") {
    throw Error("--look comanche: goes with terrain");
  }
  if (kind == InputKind::function) {
    require_settings_of(options.march.empty() ? kFunctionMarch : options.march, options.given, options.march_settings);
  }
}

void render_vox(RenderOptions options, const ViewSettings& view) {
  VoxelSceneOptions voxels;
  if (!options.march.empty()) voxels.march = options.march;
  find_voxel_march(voxels.march);
  voxels.surface_colours = options.vox.surface_colours;
  voxels.rounding = options.vox_look.rounding;
  const VoxelShading shading = shading_of(options.vox_look);
  // From over the default camera's shoulder: walls that face it are lit.
  if (options.sun.empty()) options.picture.sun.azimuth_deg = 235;
  ReplaceFile file(options.output);
  Watch watch;
  VoxInput input = read_voxels(options.inputs.front(), options.vox, voxels, options.picture.ramp);
  stop_if_interrupted();
  const double read_s = watch.lap();
  Scene scene({scene_voxels(std::move(input.scene), voxels.march, shading)}, {SceneObject{}});
  stop_if_interrupted();
  const Box box = picture_box(scene);
  if (options.top && options.size.empty()) fit_size_to_ground(box, options.picture);
  const Camera camera = camera_of(options, view, box, 0);
  if (options.vox_look.coarse) scene = scene.coarser(detail_of(camera, options.picture.aa));
  stop_if_interrupted();
  const double build_s = watch.lap();
  write_scene_picture(options, file, scene, {}, camera, watch, read_s, build_s);
}

// The file's own settings hold where no option was given.
void render_scene_file(RenderOptions options, ViewSettings view) {
  ReplaceFile file(options.output);
  Watch watch;
  const SceneFile document = read_scene(options.inputs.front(), terminal_progress("read"));
  keep_inputs(options.output, document.files);
  stop_if_interrupted();
  const double read_s = watch.lap();
  options.picture = picture_of(document, options.picture, options.given);
  view = view_of(document, view, options.given);
  const bool typed = options.top || !options.view.empty() || !options.eye.empty();
  if (options.top && options.size.empty()) fit_size_to_ground(picture_box(document.scene), options.picture);
  const int width = options.picture.width, height = options.picture.height;
  options.fov_deg = view.fov_deg;
  const Camera camera =
      !typed && document.camera.eye
          ? Camera::look_at(*document.camera.eye, *document.camera.target, view.fov_deg, width, height)
      : !options.eye.empty() && !options.target.empty() ? camera_of(options, view, {}, 0)
                                                        : camera_of(options, view, picture_box(document.scene), 0);
  const bool coarse = document.picture.coarse_voxels || options.vox_look.coarse;
  const auto [scene, device] = scene_on_device(
      options.device, coarse ? document.scene.coarser(detail_of(camera, options.picture.aa)) : document.scene);
  const double build_s = options.device.empty() ? 0 : watch.lap();
  for (const std::string& note : document.notes) fmt::print(stderr, "note: {}\n", note);
  write_scene_picture(options, file, scene, look_of(document), camera, watch, read_s, build_s, device);
}

// From under the ground one sees its other side, and through it: worth a word.
void tell_if_buried(const Camera& camera, const HeightField& field, const std::string& whose = "the eye") {
  const auto ground = field.height(camera.eye().x, camera.eye().y);
  if (!ground || camera.eye().z >= *ground) return;
  fmt::print(stderr, "note: {} is {} m below the ground\n", whose, metres_text(*ground - camera.eye().z));
}

void render_frame(const RenderOptions& options, const TerrainScene& scene, MeshInput& mesh, const Camera& camera,
                  double grid_north_azimuth, const std::string& name) {
  ReplaceFile file(name);
  const Progress listen = [](double) { return caught_signal() == 0; };
  if (options.exr) {
    write_layers(file, name, mesh.layers(scene, camera, grid_north_azimuth, options.picture, listen), camera,
                 depth_range_of(options.depth));
    return;
  }
  Picture picture = mesh.picture(scene, camera, grid_north_azimuth, options.picture, listen);
  draw_figure_of(options.figure, options.picture, scene, camera, options.top, picture);
  write_png(file, name, {picture.image.rgb.data(), picture.image.width, picture.image.height});
  tell_if_buried(camera, scene.field(), fmt::format("the eye of '{}'", name));
}

void render_terrain(RenderOptions options, const ViewSettings& view) {
  const HeightMarchEntry& march = find_height_march(options.march.empty() ? kTerrainMarch : options.march);
  const SceneMaker scenes = scene_maker(options.device, march);
  // Reserved first: an unwritable place is found before the work and not after it.
  ReplaceFile file(options.output);

  Watch watch;
  MeshInput mesh(options.mesh);
  Raster raster = read_tiles(options.inputs, options.raster, terminal_progress("read"));
  stop_if_interrupted();
  const double read_s = watch.lap();
  const double grid_north_azimuth = raster.georeference.grid_north_azimuth;
  const std::vector<std::string> notes = raster.notes;
  const std::string path = raster.path;

  const std::vector<std::string> look_files =
      read_look_files(options.look_options, raster, options.field, options.picture);
  std::vector<std::string>& files = options.typed;
  files.insert(files.end(), raster.files.begin(), raster.files.end());
  files.insert(files.end(), look_files.begin(), look_files.end());
  keep_inputs(options.output, files);
  HeightField field = height_field_from(std::move(raster), options.field);
  if (!field.has_cells()) {
    throw Error(fmt::format("raster '{}': {} x {} samples have no cells between them; at least 2 x 2 are needed", path,
                            field.cols(), field.rows()));
  }
  if (field.all_nodata()) {
    throw Error(fmt::format("raster '{}': all samples are nodata; is the nodata value right (--nodata)?", path));
  }
  if (field.wraps()) options.picture.plinth = false;
  const TerrainScene scene = scenes.make(std::move(field), march, options.march_settings);
  mesh.stand_on(scene);
  stop_if_interrupted();
  const double build_s = watch.lap();

  const Box box = picture_box(scene.field(), options.picture.plinth);
  if (options.top && options.size.empty()) fit_size_to_ground(box, options.picture);
  finish_look(options.look_options, scene.field(), options.picture);
  // Last: who fails says one line alone.
  double raised = 0;  // metres, of the eye, the most of all frames
  const auto tell_notes = [&] {
    for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
    for (const std::string& note : mesh.notes()) fmt::print(stderr, "note: {}\n", note);
    if (raised > 0) {
      fmt::print(stderr, "note: the eye is raised by {}{} m, out of the ground\n",
                 options.frames.several() ? "up to " : "", metres_text(raised));
    }
  };
  const auto set_reach = [&](Camera& camera) {
    camera.set_reach(reach_of(options.look_options, scene.field(), box, camera));
  };
  if (options.frames.several()) {
    std::vector<Camera> cameras = frame_cameras(
        options.frames, view, options.picture.width, options.picture.height, [&](const ViewSettings& turned) {
          return framed_camera(options, turned, scene.field(), box, grid_north_azimuth, raised);
        });
    for (Camera& camera : cameras) set_reach(camera);
    // Without --overwrite nothing is written over.
    for (int i = 0; options.frames.overwrite && i < static_cast<int>(cameras.size()); ++i)
      keep_inputs(frame_name(options.output, i), files);
    make_frames(options.frames, options.output, cameras, [&](const Camera& camera, const std::string& name) {
      render_frame(options, scene, mesh, camera, grid_north_azimuth, name);
    });
    tell_notes();
    return;
  }
  Camera camera = terrain_camera(options, view, scene.field(), box, grid_north_azimuth, raised);
  set_reach(camera);
  see_from_afar(options.look_options, box, camera, options.picture);
  if (options.exr) {
    const PictureLayers layers =
        mesh.layers(scene, camera, grid_north_azimuth, options.picture, terminal_progress("render"));
    const double render_s = watch.lap();
    write_layers(file, options.output, layers, camera, depth_range_of(options.depth));
    tell_notes();
    tell_if_buried(camera, scene.field());
    print_times(options, read_s, build_s, render_s, scenes.device);
    return;
  }
  Picture picture = mesh.picture(scene, camera, grid_north_azimuth, options.picture, terminal_progress("render"));
  draw_figure_of(options.figure, options.picture, scene, camera, options.top, picture);
  const double render_s = watch.lap();
  write_png(file, options.output, {picture.image.rgb.data(), picture.image.width, picture.image.height});
  tell_notes();
  tell_if_buried(camera, scene.field());
  print_times(options, read_s, build_s, render_s, scenes.device);
  print_findings(picture);
}

void render_function_input(const RenderOptions& options, const ViewSettings& view) {
  const auto given = [&](const char* option) { return is_given(options.given, option); };
  render_function(options.function,
                  {options.picture, options.march, options.march_settings, view, given("--view"), given("--fov"),
                   given("--haze"), given("--error-tolerance"), options.device, options.eye, options.target,
                   options.exr, depth_range_of(options.depth)},
                  options.output);
}

InputKind kind_of(const RenderOptions& options) {
  if (!options.function.function.empty()) {
    if (options.inputs.empty()) return InputKind::function;
    throw Error(fmt::format("'{}': --function stands in the place of files; give one of both", options.inputs.front()));
  }
  if (options.inputs.empty()) throw CLI::RequiredError("IN (or --function NAME)");
  if (!options.function.preset.empty())
    throw Error("--preset: has the numbers of shaders over functions; add --function");
  if (is_scene_input(options.inputs)) return InputKind::scene;
  return is_vox_input(options.inputs, options.vox) ? InputKind::voxels : InputKind::terrain;
}

void run(RenderOptions options) {
  const InputKind kind = kind_of(options);
  require_effect(options, kind);
  const ViewSettings view = settle(options);
  keep_inputs(options.output, options.typed);
  if (!options.eye.empty()) point_from(options.eye, "--eye");
  if (!options.target.empty()) point_from(options.target, "--target");
  const ThreadLimit limit(options.threads);
  switch (kind) {
    case InputKind::terrain:
      return render_terrain(std::move(options), view);
    case InputKind::voxels:
      return render_vox(std::move(options), view);
    case InputKind::scene:
      return render_scene_file(std::move(options), view);
    case InputKind::function:
      return render_function_input(options, view);
  }
}

}  // namespace

void add_render(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("render", "Render an elevation model, a voxel model or a scene into a picture");
  const auto options = std::make_shared<RenderOptions>();
  RenderOptions& o = *options;
  add_raster_inputs(*command, o.inputs)->required(false);
  command
      ->add_option("-o,--output", o.output,
                   "the picture: .png, or .exr in linear light with depth, normal, position and steps")
      ->required();
  command->add_option("--size", o.size, "WIDTHxHEIGHT in pixels (1280x720; with --top the shape of the ground)");
  command->add_option("--look", o.look, "shaded, height, steps, error, comanche")->capture_default_str();
  add_field_options(*command, o.field, BeyondBorders::mirrors);
  command->add_option(
      "--sun", o.sun,
      "AZIMUTH,ALTITUDE of the sun in degrees, compass and above the horizon (315,45; of voxels 235,45)");
  command->add_flag("--no-shadows", o.no_shadows, "hill shade only: the sun shines through the ground");
  command
      ->add_option(
          "--samples", o.picture.samples,
          "rays to the sun's disc for soft shadows, and as many to the sky for ambient occlusion, per sample of "
          "the shaded look: 1 to 4096, best a power of 2; 0: hard shadows alone")
      ->capture_default_str();
  command
      ->add_option("--sun-size", o.picture.sun.size_deg,
                   "apparent diameter of the sun in degrees for --samples, 0 to 90; 0: hard shadows")
      ->check(number_in({0, 90}))
      ->capture_default_str();
  command
      ->add_option("--ao-distance", o.picture.ao_distance,
                   "metres within which ground hides the sky (the whole field); 0: no ambient occlusion")
      ->check(number_in(kZeroOrMore));
  command->add_option("--seed", o.picture.seed, "of the pattern of --samples")
      ->check([](const std::string& text) {
        return check_whole_number(text, std::numeric_limits<decltype(o.picture.seed)>::max());
      })
      ->capture_default_str();
  command->add_flag("--no-plinth", o.no_plinth, "no walls below the terrain's border");
  command
      ->add_option("--haze", o.picture.haze,
                   "share of haze over a distance as long as the field's diagonal (of functions "
                   "over --extent, 0.2), 0 to 0.95")
      ->check(number_in({0, 0.95}))
      ->capture_default_str();
  command->add_option("--aa", o.picture.aa, "N x N samples per pixel of the shaded look, 1 to 16")
      ->capture_default_str();
  command
      ->add_option("--error-tolerance", o.picture.error_tolerance,
                   "of the error look along the ray, in sides of a cell; of functions in percent of the distance (1)")
      ->check(number_in(kZeroOrMore))
      ->capture_default_str();
  add_look_options(*command, o.look_options);
  add_device_option(*command, o.device);
  command->add_option("--threads", o.threads, "threads, 0 for all")->check(CLI::Range(0, 1024))->capture_default_str();

  const std::string from = "Where from";
  CLI::Option* view = command
                          ->add_option("--view", o.view,
                                       "AZIMUTH,ELEVATION[,DISTANCE]: the camera stands at that compass azimuth and "
                                       "elevation in degrees; distance in "
                                       "multiples of the one at which all just fits (190,35,1)")
                          ->group(from);
  CLI::Option* eye =
      command
          ->add_option("--eye", o.eye, "X,Y,Z in metres: x east, y north from the south-west sample, z up, exaggerated")
          ->group(from);
  command->add_option("--target", o.target, "X,Y,Z that the eye looks at (the middle)")->group(from)->needs(eye);
  CLI::Option* fov = command->add_option("--fov", o.fov_deg, "vertical angle of view in degrees, 1 to 150")
                         ->check(number_in({1, 150}))
                         ->group(from)
                         ->capture_default_str();
  command->add_flag("--top", o.top, "a map: straight down, no perspective, grid north up")
      ->group(from)
      ->excludes(view)
      ->excludes(eye)
      ->excludes(fov);
  view->excludes(eye);

  add_frame_options(*command, o.frames);
  add_depth_options(*command, o.depth);
  add_figure_options(*command, o.figure);
  add_mesh_options(*command, o.mesh);
  add_function_options(*command, o.function, o.march, o.march_settings);
  command->add_option("--march", o.march, "technique, see 'scarp marches' (max-mip; voxel-bricks; lipschitz-local)")
      ->group("Settings of marches");
  add_march_options(*command, o.march_settings);
  add_raster_options(*command, o.raster);
  add_vox_options(*command, o.vox);
  add_vox_look_options(*command, o.vox_look);
  command->callback([options, command, fov] {
    options->fov_said = fov->count() > 0;
    options->given = given_options(*command);
    options->typed = typed_values(*command);
    run(*options);
  });
}

}  // namespace scarp::cli
