// SPDX-License-Identifier: MIT
#include "app/cli/picture/render_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/picture/depth_layer.h"
#include "app/cli/picture/exr_output.h"
#include "app/cli/picture/figure.h"
#include "app/cli/picture/findings.h"
#include "app/cli/picture/picture_output.h"
#include "app/cli/picture/prepared_scene.h"
#include "app/cli/picture/seen.h"
#include "app/cli/progress.h"
#include "app/options/numbers.h"
#include "scarp/base/error.h"
#include "scarp/base/replace_file.h"
#include "scarp/render/frame/contour_spacing.h"

namespace scarp::cli {
namespace {

class Render {
 public:
  Render(InputKind kind, RenderOptions options) : prepared_(kind, std::move(options)) {}

  void run() {
    // The file is reserved first, so that an unwritable path is reported before the work starts.
    ReplaceFile file(options().output);
    prepared_.open();
    if (options().frames.several()) return make_all();
    Camera camera = prepared_.camera();
    prepared_.finish(camera);
    const PictureSettings settings = prepared_.picture(camera);
    const auto begin = std::chrono::steady_clock::now();
    const Picture picture = make(file, options().output, settings, camera, terminal_progress("render"));
    look_for_mesh(settings, camera);
    const double render_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    tell_notes();
    tell_of_contours(settings, camera);
    if (!blank_.tell()) tell_if_buried(camera, "the eye");
    fmt::print("{}: {} x {} pixels; {}read {:.2f} s, build {:.2f} s, render {:.2f} s{}\n", options().output,
               written_.width, written_.height, prepared_.input().march.empty() ? "" : prepared_.input().march + "; ",
               prepared_.read_seconds(), prepared_.build_seconds(), render_s, prepared_.on_device());
    print_findings(picture);
  }

 private:
  const RenderOptions& options() const { return prepared_.options(); }
  const PictureFormat& format() const { return picture_format_of(options().output); }

  void make_all() {
    const FrameOptions& frames = options().frames;
    const std::vector<Camera> cameras = frame_cameras(
        frames, prepared_.view(), prepared_.picture().width, prepared_.picture().height,
        [&](const ViewSettings& turned) { return prepared_.framed(turned); }, prepared_.path_places());
    std::vector<std::string> inputs = options().typed;
    inputs.insert(inputs.end(), prepared_.input().files.begin(), prepared_.input().files.end());
    // Without --overwrite no file is overwritten.
    for (int i = 0; frames.overwrite && i < static_cast<int>(cameras.size()); ++i)
      keep_inputs(frame_name(options().output, i), inputs);
    make_frames(frames, options().output, cameras, [&](Camera camera, const std::string& name) {
      prepared_.finish(camera);
      ReplaceFile file(name);
      const int blank_before = blank_.count();
      make(file, name, prepared_.picture(), camera, [](double) { return caught_signal() == 0; });
      look_for_mesh(prepared_.picture(), camera);
      if (!format().layers && blank_.count() == blank_before)
        tell_if_buried(camera, fmt::format("the eye of '{}'", name));
    });
    tell_notes();
    if (!cameras.empty()) tell_of_contours(prepared_.picture(), cameras.front());
    blank_.tell();
  }

  // Renders and writes one picture. Returns the findings; layers have none.
  Picture make(ReplaceFile& file, const std::string& name, const PictureSettings& settings, const Camera& camera,
               const Progress& progress) {
    look_through(prepared_.there(), camera, entry_of(settings.look).antialiased || format().layers ? settings.aa : 1);
    if (format().layers) {
      const PictureLayers layers = render_layers(prepared_.scene(), camera, settings, progress);
      look_if_blank(name, settings, camera, has_one_colour(layers));
      const DepthLayer depth = depth_layer(layers.depth, options().depth);
      if (depth_note_.empty()) depth_note_ = depth.note;
      write_layers(file, name, layers, camera, depth.values);
      written_ = {layers.width, layers.height};
      return {};
    }
    const FigureSubject subject{prepared_.scene(),
                                camera,
                                options().camera.top,
                                prepared_.input().numbers,
                                prepared_.input().raster.georeference,
                                prepared_.input().raster.cols,
                                prepared_.input().raster.rows};
    std::optional<Figure> figure = figure_of(options().figure, settings, subject);
    Picture picture = render_picture(prepared_.scene(), camera, settings, progress);
    // A picture of the look error has one colour if nothing is wrong.
    look_if_blank(name, settings, camera, settings.look != Look::error && has_one_colour(picture.image));
    add_legend(options().figure, settings, subject, picture, figure);
    std::optional<MapPlace> place;
    if (format().map) {
      place = place_of_map(camera, picture.image.width, picture.image.height, prepared_.input().raster.georeference,
                           prepared_.input().raster.cols, prepared_.input().raster.rows);
    }
    written_ = write_picture(file, name, format(), picture.image, figure, place, options().figure.dots_per_inch);
    return picture;
  }

  void look_if_blank(const std::string& name, const PictureSettings& settings, const Camera& camera, bool one_colour) {
    BlankFacts facts = prepared_.facts();
    facts.one_colour = one_colour;
    blank_.add(name, why_blank(prepared_.scene(), camera, settings, facts));
  }

  // A mesh that one frame shows needs no note.
  void look_for_mesh(const PictureSettings& settings, const Camera& camera) {
    if (options().mesh.file.empty() || mesh_seen_) return;
    const Scene& scene = prepared_.scene();
    mesh_unseen_ = why_unseen(scene, static_cast<std::uint32_t>(scene.objects().size() - 1), camera, settings);
    mesh_seen_ = mesh_unseen_.empty();
  }

  // Printed last: a run that fails prints only one line.
  void tell_notes() const {
    for (const std::string& note : prepared_.input().notes) fmt::print(stderr, "note: {}\n", note);
    if (const std::string note = note_on_low_water(prepared_.scene(), prepared_.picture(), prepared_.facts());
        !note.empty())
      fmt::print(stderr, "note: {}\n", note);
    if (!mesh_unseen_.empty()) fmt::print(stderr, "note: --mesh {} {}\n", options().mesh.file, mesh_unseen_);
    if (format().map && !prepared_.input().raster.georeference.present)
      fmt::print(stderr, "note: the input has no georeference, nor has {}\n", options().output);
    if (!depth_note_.empty()) fmt::print(stderr, "note: {}\n", depth_note_);
    if (prepared_.raised() > 0) {
      fmt::print(stderr, "note: the eye is raised by {}{} m, out of the ground\n",
                 options().frames.several() ? "up to " : "", metres_text(prepared_.raised()));
    }
  }

  // Warns about invisible contour lines.
  void tell_of_contours(const PictureSettings& settings, const Camera& camera) const {
    const double interval = settings.ground.contours;
    if (!(interval > 0)) return;
    const PaintExtent extent = paint_extent(prepared_.scene(), settings);
    const double low = extent.low / extent.exaggeration, high = extent.high / extent.exaggeration;
    if (std::ceil(low / interval) > std::floor(high / interval)) {
      fmt::print(stderr, "note: --contours {:g}: no line lies between {:.6g} and {:.6g} m, the heights of the scene\n",
                 interval, low, high);
    } else if (const auto better = better_contours(prepared_.scene(), camera, settings)) {
      fmt::print(stderr,
                 "note: --contours {:g}: the lines are closer than pixels and left out nearly everywhere; --contours "
                 "{:g} shows them\n",
                 interval, *better);
    }
  }

  // Warns about eyes below the ground, whose underside is invisible.
  void tell_if_buried(const Camera& camera, const std::string& whose) const {
    const auto ground = prepared_.scene().height(camera.eye().x, camera.eye().y);
    if (!ground || camera.eye().z >= *ground) return;
    fmt::print(stderr, "note: {} is {} m below the ground\n", whose, metres_text(*ground - camera.eye().z));
  }

  PreparedScene prepared_;
  WrittenSize written_;
  BlankPictures blank_;
  std::string depth_note_;  // of the first picture that has one
  bool mesh_seen_ = false;
  std::string mesh_unseen_;  // why no picture so far shows the mesh; empty: one does, or there is no mesh
};

}  // namespace

void render_input(InputKind kind, RenderOptions options) { Render(kind, std::move(options)).run(); }

}  // namespace scarp::cli
