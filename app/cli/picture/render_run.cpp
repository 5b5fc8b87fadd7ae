// SPDX-License-Identifier: MIT
#include "app/cli/picture/render_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/options/kept_inputs.h"
#include "app/cli/picture/comparison.h"
#include "app/cli/picture/depth_layer.h"
#include "app/cli/picture/exr_output.h"
#include "app/cli/picture/figure.h"
#include "app/cli/picture/findings.h"
#include "app/cli/picture/picture_output.h"
#include "app/cli/picture/prepared_scene.h"
#include "app/cli/picture/raster_output.h"
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
  // `blank` collects the blank pictures.
  Render(InputKind kind, const RenderOptions& options, BlankPictures& blank)
      : blank_(blank),
        march_(march_of(options, kind)),
        prepared_(kind, options.compared.empty() ? options : with_march(options, options.compared.front())),
        comparison_(kind, prepared_, options.compared) {}

  void run() {
    // The file is reserved first, so that an unwritable path is reported before the work starts.
    ReplaceFile file(options().output);
    prepared_.open();
    comparison_.open();
    if (options().frames.fly()) return make_all();
    Camera camera = prepared_.camera();
    prepared_.finish(camera);
    const PictureSettings settings = prepared_.picture(camera);
    const auto begin = std::chrono::steady_clock::now();
    const Picture picture = make(file, options().output, settings, camera, terminal_progress("render"));
    look_for_mesh(settings, camera);
    const double render_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (options().quiet) {
      blank_.tell();
      return;
    }
    print_notes(notes());
    tell_of_contours(settings, camera);
    if (!blank_.tell()) tell_if_buried(camera, "the eye");
    if (options().json) return print_report(picture, render_s);
    const std::string march = comparison_ ? "" : prepared_.input().march;
    fmt::print("{}: {} x {} pixels; {}read {:.2f} s, build {:.2f} s, render {:.2f} s{}\n", options().output,
               written_.width, written_.height, march.empty() ? "" : march + "; ", prepared_.read_seconds(),
               prepared_.build_seconds(), render_s, prepared_.on_device());
    comparison_ ? comparison_.print() : print_findings(picture);
  }

  // A frame of an animation, called `shown` in messages. Prints nothing.
  void make_frame(const std::string& shown) {
    const SilentProgress silence;
    ReplaceFile file(options().output);
    prepared_.open();
    comparison_.open();
    Camera camera = prepared_.camera();
    prepared_.finish(camera);
    make(file, shown, prepared_.picture(camera), camera, [](double) { return caught_signal() == 0; });
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> notes = prepared_.input().notes;
    if (std::string note = note_on_low_water(prepared_.scene(), prepared_.picture(), prepared_.facts()); !note.empty())
      notes.push_back(std::move(note));
    if (!mesh_unseen_.empty()) notes.push_back(fmt::format("--mesh {} {}", options().mesh.file, mesh_unseen_));
    if (format().map && !prepared_.input().raster.georeference.present)
      notes.push_back(fmt::format("the input has no georeference, nor has {}", options().output));
    if (!depth_note_.empty()) notes.push_back(depth_note_);
    if (prepared_.raised() > 0) {
      notes.push_back(fmt::format("the eye is raised by {}{} m, out of the ground",
                                  options().frames.fly() ? "up to " : "", metres_text(prepared_.raised())));
    }
    return notes;
  }

 private:
  const RenderOptions& options() const { return prepared_.options(); }
  const PictureFormat& format() const { return picture_format_of(options().output); }

  void print_report(const Picture& picture, double render_s) const {
    nlohmann::ordered_json report{{"file", options().output}, {"width", written_.width}, {"height", written_.height}};
    if (comparison_) {
      report["compared"] = comparison_.describe();
    } else if (const std::string& march = march_.empty() ? prepared_.input().march : march_; !march.empty()) {
      report["march"] = march;
    }
    if (!prepared_.there().device.empty()) report["device"] = prepared_.there().device;
    report["read_s"] = prepared_.read_seconds(), report["build_s"] = prepared_.build_seconds();
    report["render_s"] = render_s;
    if (!comparison_) report.update(describe_findings(picture));
    fmt::print("{}\n", report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }

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
    make_frames(frames, options().output, static_cast<int>(cameras.size()), [&](int i, const FrameFile& frame) {
      Camera camera = cameras[static_cast<std::size_t>(i)];
      prepared_.finish(camera);
      ReplaceFile file(frame.path);
      const int blank_before = blank_.count();
      make(file, frame.shown, prepared_.picture(), camera, [](double) { return caught_signal() == 0; });
      look_for_mesh(prepared_.picture(), camera);
      if (!options().quiet && !format().layers && blank_.count() == blank_before)
        tell_if_buried(camera, fmt::format("the eye of '{}'", frame.shown));
    });
    if (!options().quiet) print_notes(notes());
    if (!options().quiet && !cameras.empty()) tell_of_contours(prepared_.picture(), cameras.front());
    blank_.tell();
  }

  // Renders and writes one picture, called `name` in messages. Returns the findings; layers have none.
  Picture make(ReplaceFile& file, const std::string& name, const PictureSettings& settings, const Camera& camera,
               const Progress& progress) {
    look_through(prepared_.there(), camera, entry_of(settings.look).antialiased ? settings.aa : 1);
    if (format().layers && settings.look == Look::error) {
      Picture picture = render_picture(prepared_.scene(), camera, settings, progress);
      look_if_blank(name, settings, camera, false);
      write_error_layers(file, name, picture, camera);
      written_ = {picture.image.width, picture.image.height};
      return picture;
    }
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
                                prepared_.input().raster.rows,
                                comparison_.blank_strips()};
    std::optional<Figure> figure = figure_of(options().figure, settings, subject);
    Picture picture =
        comparison_ ? comparison_.render(camera) : render_picture(prepared_.scene(), camera, settings, progress);
    if (comparison_) figure->strips = comparison_.strips();
    // A picture of the look error has one colour if nothing is wrong.
    look_if_blank(name, settings, camera, settings.look != Look::error && has_one_colour(picture.image));
    add_legend(options().figure, settings, subject, picture, figure);
    std::optional<MapPlace> place;
    if (format().map) {
      place = place_of_map(camera, picture.image.width, picture.image.height, prepared_.input().raster.georeference,
                           prepared_.input().raster.cols, prepared_.input().raster.rows);
    }
    if (writes_numbers(options())) {
      if (prepared_.has_pixel_per_sample()) place = map_place(prepared_.input().raster.georeference);
      write_numbers(options().output, picture, settings.look, place);
      written_ = {picture.image.width, picture.image.height};
      return picture;
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

  BlankPictures& blank_;
  const std::string march_;  // empty: of a scene file
  PreparedScene prepared_;
  Comparison comparison_;
  WrittenSize written_;
  std::string depth_note_;  // of the first picture that has one
  bool mesh_seen_ = false;
  std::string mesh_unseen_;  // why no picture so far shows the mesh; empty: one does, or there is no mesh
};

}  // namespace

void render_animation(InputKind kind, const RenderOptions& options,
                      const std::function<RenderOptions(int)>& options_of) {
  BlankPictures blank;
  std::optional<std::vector<std::string>> notes;  // those of the first frame stand for all
  make_frames(options.frames, options.output, options.frames.chosen(), [&](int i, const FrameFile& file) {
    RenderOptions frame = options_of(i);
    frame.output = file.path;
    if (options.frames.overwrite) keep_inputs(file.path, frame.typed);
    Render render(kind, frame, blank);
    render.make_frame(file.shown);
    if (!notes) notes = render.notes();
  });
  if (notes && !options.quiet) print_notes(*notes);
  blank.tell();
}

void render_input(InputKind kind, const RenderOptions& options) {
  BlankPictures blank;
  Render(kind, options, blank).run();
}

}  // namespace scarp::cli
