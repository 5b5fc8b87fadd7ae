// SPDX-License-Identifier: MIT
// `scarp cast`: rays of a table against an elevation model, hits out.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/device_option.h"
#include "app/cli/field_options.h"
#include "app/cli/kept_inputs.h"
#include "app/cli/march_options.h"
#include "app/cli/progress.h"
#include "app/cli/raster_options.h"
#include "app/cli/scene_input.h"
#include "app/cli/shared_options.h"
#include "app/cli/vox_input.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/exhaustive.h"
#include "scarp/march/height/max_mip.h"
#include "scarp/march/height/queries.h"
#include "scarp/output/hit_table.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/scene/scene.h"
#include "scarp/source/coordinates.h"
#include "scarp/source/ray_table.h"
#include "scarp/source/read_raster.h"

namespace scarp::cli {
namespace {

// Rays are answered and written by the piece: a table of any length needs the memory of its rays, not of its hits.
constexpr std::size_t kPiece = 1 << 16;

constexpr std::string_view kRasterCrs = "--raster-crs";

// Below the options in the help.
constexpr const char* kTables = R"(Rays, CSV with a header, columns in any order:
  x,y,z                 origin
  dx,dy,dz              direction; t counts in its length
  or tx,ty,tz           target instead of a direction: t is 1 there, and the ray ends there
  t_min,t_max           optional range of t (0 to infinity; 0 to 1 with a target)
  start_col,start_row   optional cell on whose surface the ray starts
  others                copied to the hits
Rays, .npy: float32 or float64 of N x 6 or N x 8: x,y,z,dx,dy,dz[,t_min,t_max]; or structures with
fields of these names.

Coordinates (--crs); z is always in metres:
  local    metres east and north of the south-west sample
  map      units of the raster's CRS, for dx,dy as well; dz in metres
  lonlat   longitude and latitude in degrees, WGS 84; dx,dy,dz are metres east, north and up

Hits: ray (from 0), status (hit, miss, below, exhausted), t, x,y,z, cell col,row, position u,v in
the cell, unit normal nx,ny,nz (east, north, up), wall (0 or 1). With --any: ray, blocked.)";

struct CastOptions {
  std::vector<std::string> inputs;
  std::string rays, output, coordinates;
  RasterOptions raster;
  FieldOptions field;
  std::string march = "max-mip";
  std::string device;
  MarchSettings march_settings;
  bool any = false, all = false;
  int threads = 0;
  std::vector<std::string> typed;  // the values of the options
};

using AllHits = HitStatus (*)(const HeightTarget&, const Ray&, std::vector<Hit>&);

// The march's function for all hits, null when those are not asked for.
AllHits all_hits_of(const CastOptions& options, const HeightMarchEntry& march) {
  if (!options.all) return nullptr;
  if (!options.device.empty()) {
    throw Error(fmt::format("--all --device {}: devices return only the first hit of a ray (leave one of the two out)",
                            options.device));
  }
  if (march.name == "max-mip") return all_hits_max_mip;
  if (march.name == "exhaustive") return all_hits_exhaustive;
  throw Error(fmt::format("--all --march {}: only max-mip and exhaustive find all hits", march.name));
}

// Readers of rasters speak of --crs, which says here what the coordinates of the rays are.
std::string in_words_of_cast(std::string text) {
  constexpr std::string_view kTheirs = "--crs";
  for (std::size_t at = 0; (at = text.find(kTheirs, at)) != std::string::npos; at += kRasterCrs.size()) {
    text.replace(at, kTheirs.size(), kRasterCrs);
  }
  return text;
}

Raster read(const CastOptions& options) {
  try {
    return read_tiles(options.inputs, options.raster, terminal_progress("read"));
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw Error(in_words_of_cast(error.what()));
  }
}

CoordinateFrame frame_of(const CastOptions& options, const Raster& raster) {
  const bool georeferenced = raster.georeference.present;
  const Coordinates coordinates = !options.coordinates.empty() ? find_coordinates(options.coordinates)
                                  : georeferenced              ? Coordinates::map
                                                               : Coordinates::local;
  try {
    return {raster.georeference, raster.cols, raster.rows, coordinates};
  } catch (const Error& error) {
    throw Error(fmt::format("raster '{}': {}", raster.path, error.what()));
  }
}

void check(const RayTable& table, std::span<const Ray> rays, const HeightField& field) {
  constexpr std::string_view kPrefix = "ray: ";
  for (std::size_t i = 0; i < rays.size(); ++i) {
    try {
      validate(rays[i], field);
    } catch (const Error& error) {
      // Here the ray has a name.
      std::string_view text = error.what();
      if (text.starts_with(kPrefix)) text.remove_prefix(kPrefix.size());
      throw Error(fmt::format("{}: {}", table.where(i), text));
    }
  }
}

// A word for tables in other coordinates than said, of which nothing is hit: where the raster lies. Empty when a ray
// begins over it, as all do where it goes on for ever.
std::string place_of_raster(std::span<const Ray> rays, const HeightField& field, const CoordinateFrame& frame) {
  const auto over = [&](const Ray& ray) {
    return ray.origin.x >= 0 && ray.origin.x <= field.width() && ray.origin.y >= 0 && ray.origin.y <= field.depth();
  };
  std::array corners = {dvec3(0.0), dvec3(field.width(), field.depth(), 0.0)};
  if (field.wraps() || std::any_of(rays.begin(), rays.end(), over) || frame.from_local(corners)) return {};
  return fmt::format(
      "nothing was hit, and no ray begins over the raster: in {} coordinates x {:.8g} to {:.8g}, "
      "y {:.8g} to {:.8g}; are the rays in these (--crs)?",
      name_of(frame.coordinates()), corners[0].x, corners[1].x, corners[0].y, corners[1].y);
}

// Answers rays and writes what they met, piece by piece.
class Caster {
 public:
  // A scene of one height field.
  Caster(const CastOptions& options, const Scene& scene, const HeightMarchEntry& march, const CoordinateFrame& frame,
         const RayTable& table, HitTable& out)
      : scene_(scene), frame_(frame), table_(table), out_(out), all_(all_hits_of(options, march)) {
    if (all_ && march.needs_pyramid) pyramid_.emplace(*scene.only_heights());
  }

  void blocked(std::size_t first, std::span<const Ray> rays) {
    std::vector<std::uint8_t> answers(rays.size());
    timed([&] { scene_.occluded(rays, answers); });
    hits_ += static_cast<std::size_t>(std::count(answers.begin(), answers.end(), 1));
    count_below(rays, answers);
    out_.add(static_cast<std::int64_t>(first), answers);
  }

  void hits(std::size_t first, std::span<const Ray> rays) {
    std::vector<std::vector<Hit>> found(rays.size());
    if (all_) {
      constexpr std::int64_t kGrain = 256;
      const HeightTarget target{scene_.only_heights(), pyramid_ ? &*pyramid_ : nullptr};
      timed([&] {
        parallel_for(static_cast<std::int64_t>(rays.size()), kGrain, [&](std::int64_t begin, std::int64_t end) {
          for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            const HitStatus status = all_(target, rays[i], found[i]);
            if (found[i].empty()) found[i].emplace_back().status = status;
          }
        });
      });
    } else {
      std::vector<Hit> closest(rays.size());
      timed([&] { scene_.closest_hits(rays, closest); });
      for (std::size_t i = 0; i < rays.size(); ++i) found[i] = {closest[i]};
    }
    write(first, rays, found);
  }

  std::size_t hits() const { return hits_; }
  /// Of blocked(): rays that are not, for they began below the ground and never came above.
  std::size_t below() const { return below_; }
  double seconds() const { return seconds_; }

 private:
  template <class Work>
  void timed(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  // Only rays that begin under the height of the ground are asked once more: nearly all begin above.
  void count_below(std::span<const Ray> rays, std::span<const std::uint8_t> blocked) {
    std::vector<Ray> low;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (blocked[i]) continue;
      const dvec3 begin = rays[i].at(rays[i].t_min);
      const auto ground = scene_.height(begin.x, begin.y);
      if (ground && begin.z < *ground) low.push_back(rays[i]);
    }
    if (low.empty()) return;
    std::vector<Hit> closest(low.size());
    scene_.closest_hits(low, closest);
    below_ += static_cast<std::size_t>(
        std::count_if(closest.begin(), closest.end(), [](const Hit& hit) { return hit.status == HitStatus::below; }));
  }

  void write(std::size_t first, std::span<const Ray> rays, const std::vector<std::vector<Hit>>& found) {
    std::vector<HitRow> rows;
    std::vector<dvec3> positions;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      for (const Hit& hit : found[i]) {
        HitRow& row = rows.emplace_back();
        row.ray = static_cast<std::int64_t>(first + i);
        row.hit = hit;
        if (!hit) continue;
        ++hits_;
        const dvec3 at = rays[i].at(hit.t);
        positions.push_back({at.x, at.y, hit.height});
        row.normal = frame_.normal_from_local(scene_.surface(rays[i], hit).normal);
      }
    }
    const auto failed = frame_.from_local(positions);
    std::size_t next = 0;
    for (HitRow& row : rows) {
      if (!row.hit) continue;
      if (failed == next) {
        throw Error(fmt::format("{}: its hit is at a place that has no longitude and latitude; use --crs map",
                                table_.where(static_cast<std::size_t>(row.ray))));
      }
      row.position = positions[next++];
    }
    out_.add(rows);
  }

  const Scene& scene_;
  const CoordinateFrame& frame_;
  const RayTable& table_;
  HitTable& out_;
  AllHits all_;
  std::optional<MaxPyramid> pyramid_;  // for all hits
  std::size_t hits_ = 0, below_ = 0;
  double seconds_ = 0;
};

void run(CastOptions options, const Command& command) {
  if (options.output == "-") options.output.clear();
  const HeightMarchEntry& march = find_height_march(options.march);
  all_hits_of(options, march);  // refuses before files are read
  command.require_effect({.kind = InputKind::terrain, .march = options.march});
  validate(options.march_settings);
  if (is_vox_input(options.inputs, {}) || is_scene_input(options.inputs)) {
    throw Error(fmt::format("'{}': cast takes elevation models, not voxels or scenes", options.inputs.front()));
  }
  if (!options.coordinates.empty()) {
    try {
      find_coordinates(options.coordinates);
    } catch (const Error&) {
      throw Error(
          fmt::format("--crs '{}': expected local, map or lonlat, the coordinates of the rays; the CRS of the "
                      "raster is named with {}",
                      options.coordinates, kRasterCrs));
    }
  }
  keep_inputs(options.output, options.typed);
  require_device_march(options.device, march);
  const ThreadLimit limit(options.threads);
  // Who reads the table may go away, as `head` does: then the program ends as others do, without a word.
  if (options.output.empty()) std::signal(SIGPIPE, SIG_DFL);

  const RayTable table = read_rays(options.rays);
  HitTable out(options.output, options.any ? TableKind::blocked : TableKind::hits, table.carried);
  Raster raster = read(options);
  keep_inputs(options.output, raster.files);
  stop_if_interrupted();
  std::vector<std::string> notes = raster.notes;
  const CoordinateFrame frame = frame_of(options, raster);
  const std::vector<Ray> rays = rays_in_local(table, frame);
  const HeightField field = height_field_from(std::move(raster), options.field);
  check(table, rays, field);
  if (!field.has_cells()) notes.push_back("a single row or column has no cells: every ray misses");
  if (field.all_nodata()) notes.push_back("all samples are nodata: every ray misses; is the nodata value right?");
  stop_if_interrupted();

  const auto [scene, device] = scene_on_device(
      options.device, Scene(scene_heights(field, march, options.march_settings,
                                          options.device.empty() ? AnsweredBy::cpu : AnsweredBy::back_end)));
  Caster caster(options, scene, march, frame, table, out);
  const Progress progress = terminal_progress("cast");
  for (std::size_t first = 0; first < rays.size(); first += kPiece) {
    const std::size_t count = std::min(kPiece, rays.size() - first);
    const std::span<const Ray> piece = std::span(rays).subspan(first, count);
    if (options.any) {
      caster.blocked(first, piece);
    } else {
      caster.hits(first, piece);
    }
    if (!progress(static_cast<double>(first + count) / static_cast<double>(rays.size()))) throw Interrupted();
  }
  out.commit();
  // Last: who fails says one line alone.
  for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", in_words_of_cast(note));
  if (caster.below() > 0) {
    fmt::print(
        stderr,
        "note: {} of {} rays begin below the ground and never come above it; they are told as not blocked, and as "
        "'below' without --any: are their heights right?\n",
        caster.below(), rays.size());
  }
  if (caster.hits() == 0 && !rays.empty()) {
    const std::string note = place_of_raster(rays, field, frame);
    if (!note.empty()) fmt::print(stderr, "note: {}\n", note);
  }
  if (::isatty(STDERR_FILENO) != 0) {
    constexpr double kTick_s = 1e-9;  // of the clock: few rays may take less
    fmt::print(stderr, "{} rays, {} {}; {:.3g} s, {:.3g} Mrays/s{}\n", rays.size(), caster.hits(),
               options.any ? "blocked" : "hits", caster.seconds(),
               static_cast<double>(rays.size()) / std::max(caster.seconds(), kTick_s) * 1e-6,
               device.empty() ? "" : ", on " + device);
  }
}

}  // namespace

void add_cast(Program& program) {
  Command& command = program.add("cast", "Intersect rays of a table with an elevation model");
  const auto options = std::make_shared<CastOptions>();
  CastOptions& o = *options;
  add_raster_inputs(command, o.inputs, "elevation raster: anything GDAL reads, .npy, .npz, .exr");
  command.add(&o.rays, {.names = "--rays",
                        .value = "FILE",
                        .help = "table of rays: .csv or .npy",
                        .files = "csv npy",
                        .note = "-: CSV from standard input",
                        .required = true});
  add_output_option(command, o.output, "table of hits: .csv or .npy; -: CSV to standard output", "csv npy", false);
  command.add(&o.coordinates,
              {.names = "--crs",
               .value = "KIND",
               .help = "coordinates of rays and hits",
               .choices = {std::string(name_of(Coordinates::local)), std::string(name_of(Coordinates::map)),
                           std::string(name_of(Coordinates::lonlat))},
               .fallback = "map; local for rasters without a place",
               .common = true});
  command.add(&o.any, {.names = "--any",
                       .help = "occlusion only: columns ray,blocked (1, or 0; 0 also for rays that start below ground)",
                       .common = true});
  command.add(&o.all,
              {.names = "--all", .help = "all hits of each ray in order of t", .common = true, .excludes = {"--any"}});
  std::vector<std::string> marches;
  for (const MarchEntry& march : height_marches()) marches.emplace_back(march.name);
  command.add(&o.march, {.names = "--march",
                         .value = "NAME",
                         .help = "marching technique",
                         .choices = std::move(marches),
                         .unlisted = true,
                         .note = "see 'scarp marches'",
                         .common = true});
  add_device_option(command, o.device);
  add_threads_option(command, o.threads);
  add_field_options(command, o.field, BeyondBorders::wraps);
  add_march_options(command, o.march_settings);
  add_raster_options(command, o.raster, std::string(kRasterCrs));
  command.footer(kTables);
  command.example("scarp cast dem.tif --rays rays.csv -o hits.csv");
  command.example("scarp cast dem.tif --rays rays.npy --crs local --any -o blocked.npy");
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
