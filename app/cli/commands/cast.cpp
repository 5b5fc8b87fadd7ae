// SPDX-License-Identifier: MIT
// `scarp cast`: intersects the rays of a table with any input of `scarp render`.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/commands/cast_part.h"
#include "app/cli/commands/cast_rays.h"
#include "app/cli/commands/cast_samples.h"
#include "app/cli/commands/scan.h"
#include "app/cli/options/device_option.h"
#include "app/cli/options/field_options.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/march_options.h"
#include "app/cli/options/open_input.h"
#include "app/cli/options/places.h"
#include "app/cli/options/raster_options.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/progress.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/height_table.h"
#include "scarp/march/height/queries.h"
#include "scarp/output/hit_table.h"
#include "scarp/output/trace_table.h"
#include "scarp/scene/scene.h"
#include "scarp/scene/voxel_entry.h"
#include "scarp/source/raster/coordinates.h"
#include "scarp/source/table/ray_table.h"

namespace scarp::cli {
namespace {

// Rays are traced and written in pieces: a table of any length needs memory for its rays, not for its hits.
constexpr std::size_t kPiece = 1 << 16;

constexpr std::string_view kFirstHit = "marches of other fields return the first hit only";

// Below the options in the help.
constexpr const char* kTables = R"(Rays, CSV with a header, columns in any order:
  x,y,z                 origin; or lon,lat,z for --coords lonlat
  dx,dy,dz              direction; its length is the unit of t
  or tx,ty,tz           target (tlon,tlat,tz) instead of a direction: t is 1, and the ray ends there
  t_min,t_max           optional range of t (0 to infinity; 0 to 1 with a target)
  start_col,start_row   optional cell of the terrain on whose surface the ray starts
  others                copied to the hits
Rays, .npy: float32 or float64 of N x 6 or N x 8: x,y,z,dx,dy,dz[,t_min,t_max]; or structures with
fields of these names.

Coordinates (--coords), also of --mesh-at; z is always in metres:
  local    metres east and north of the south-west sample, or of the origin of the scene
  map      units of the raster's CRS, for dx,dy as well; dz in metres
  lonlat   longitude and latitude in degrees, WGS 84; dx,dy,dz are metres east, north and up

Hits: ray (from 0), status (hit, miss, below, exhausted, invalid), t, x,y,z, cell col,row, position
u,v in it, unit normal nx,ny,nz (east, north, up), wall (0 or 1). For inputs other than terrain also
object, kind, material, triangle, part, voxel_x,voxel_y,voxel_z, face. With --any: ray, blocked.

Scanner (--scanner), JSON: elevations, azimuths, rate, and a pose or a path of poses; optional:
turns, range, noise, mounting, time_offsets, azimuth_offsets (doc/user/scanners.md). Points: time,
column, channel, azimuth, elevation, range, x,y,z, object. LAS is version 1.4, point format 6.)";

struct CastOptions : InputOptions {
  std::string rays, output, coordinates, samples;
  ScanOptions scan;
  bool any = false, all = false, skip_bad = false;
  int threads = 0;
  std::vector<std::string> typed;  // the values of the options
};

// The march that finds all hits, null if they are not requested.
const HeightMarchEntry* all_hits_of(const CastOptions& options) {
  if (!options.all) return nullptr;
  if (!options.device.empty()) {
    throw Error(fmt::format("--all --device {}: devices return only the first hit of a ray (leave one of the two out)",
                            options.device));
  }
  const HeightMarchEntry& march = find_height_march(march_of(options, InputKind::terrain));
  if (march.all_hits) return &march;
  throw Error(fmt::format("--all --march {}: only max-mip and exhaustive find all hits", march.name));
}

// Only rasters have a georeference. z of rays and hits is that of the field, exaggerated in all coordinates.
Places places_of(const CastOptions& options, const OpenedInput& input, const std::optional<CastPart>& part) {
  const Coordinates coordinates = !options.coordinates.empty() ? find_coordinates(options.coordinates)
                                  : input.georeference.present ? Coordinates::map
                                                               : Coordinates::local;
  if (part) return {part->raster, coordinates, 1};
  return {{input.path, input.georeference, input.cols, input.rows}, coordinates, 1};
}

// A note with the bounds of the scene, for rays that hit nothing: the table may be in other coordinates. Empty if a ray
// starts above the scene, or the scene is unbounded.
std::string place_of(const Scene& scene, std::span<const Ray> rays, const Places& places) {
  const WorldBox box = ground_box(scene);
  const auto over = [&](const Ray& ray) {
    return ray.origin.x >= box.low.x && ray.origin.x <= box.high.x && ray.origin.y >= box.low.y &&
           ray.origin.y <= box.high.y;
  };
  const std::string bounds = places.bounds_text(scene);
  if (bounds.empty() || std::any_of(rays.begin(), rays.end(), over)) return {};
  const std::string place = fmt::format("in {} coordinates {}", name_of(places.frame().coordinates()), bounds);
  return scene.only_heights()
             ? fmt::format("nothing was hit, and no ray begins over the raster: {}; are the rays in these (--coords)?",
                           place)
             : fmt::format("nothing was hit, and no ray begins over the scene: {}", place);
}

// Traces rays and writes their hits, piece by piece.
class Caster {
 public:
  // `all` finds all hits and needs a scene of one height field; null: nearest hits only. `materials`: number of
  // materials of the scene file.
  Caster(const HeightMarchEntry* all, const Scene& scene, std::size_t materials, const CoordinateFrame& frame,
         const RayTable& table, HitTable& out, const std::optional<CastPart>& part)
      : scene_(scene), frame_(frame), table_(table), out_(out), all_(all), materials_(materials), part_(part) {
    if (all_ && all_->needs_pyramid) pyramid_.emplace(*scene.only_heights());
  }

  void blocked(std::size_t first, std::span<const Ray> rays) {
    std::vector<std::uint8_t> answers(rays.size());
    timed([&] { scene_.occluded(rays, answers); });
    hits_ += static_cast<std::size_t>(std::count(answers.begin(), answers.end(), 1));
    count_below(rays, answers);
    if (table_.bad.empty()) return out_.add(static_cast<std::int64_t>(first), answers);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      add_bad_before(table_.index(first + i));
      out_.add(table_.index(first + i), std::span(answers).subspan(i, 1));
    }
  }

  void hits(std::size_t first, std::span<const Ray> rays) {
    std::vector<std::vector<Hit>> found(rays.size());
    if (all_) {
      constexpr std::int64_t kGrain = 256;
      const HeightTarget target{scene_.only_heights(), pyramid_ ? &*pyramid_ : nullptr};
      timed([&] {
        parallel_for(static_cast<std::int64_t>(rays.size()), kGrain, [&](std::int64_t begin, std::int64_t end) {
          for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            const HitStatus status = all_->all_hits(target, rays[i], found[i]);
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

  // Writes the bad rays in front of a ray that were not written yet.
  void add_bad_before(std::int64_t ray) {
    for (; bad_ < table_.bad.size() && table_.bad[bad_].ray < ray; ++bad_) out_.add_invalid(table_.bad[bad_].ray);
  }

  std::size_t hits() const { return hits_; }
  /// Returns the number of rays that start below ground and never emerge; hits() also counts those that enter below
  /// ground through the border.
  std::size_t below() const { return below_; }
  double seconds() const { return seconds_; }

 private:
  template <class Work>
  void timed(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  // Counts rays that are not blocked because they are below ground. Only rays that start below the height of the ground
  // are traced again: nearly all start above.
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
    std::vector<std::size_t> sources;  // rows of the rays of positions
    for (std::size_t i = 0; i < rays.size(); ++i) {
      for (const Hit& hit : found[i]) {
        HitRow& row = rows.emplace_back();
        row.ray = table_.index(first + i);
        row.hit = hit;
        if (hit.status == HitStatus::below) ++below_;
        if (!hit) continue;
        ++hits_;
        const SceneSurface surface = scene_.surface(rays[i], hit);
        row.normal = frame_.normal_from_local(surface.normal);
        if (part_) row.hit.cell = {hit.cell.col + part_->part.col, hit.cell.row + part_->part.row};
        row.kind = *find_hit_kind(scene_.field_of(hit.object).kind());
        row.hit.voxel = file_voxel(scene_, hit).value_or(hit.voxel);
        if (surface.material < materials_) row.material = surface.material;
        sources.push_back(first + i);
        dvec3& at = positions.emplace_back(rays[i].at(hit.t));
        if (part_) at = at + part_->origin;
        if (scene_.only_field() && row.kind != HitKind::voxels) at.z = hit.height;
      }
    }
    const auto failed = frame_.from_local(positions);
    std::size_t next = 0;
    for (HitRow& row : rows) {
      if (!row.hit) continue;
      if (failed == next) {
        throw Error(fmt::format("{}: its hit is at a place that has no longitude and latitude; use --coords map",
                                table_.where(sources[next])));
      }
      row.position = positions[next++];
    }
    if (table_.bad.empty()) return out_.add(rows);
    for (const HitRow& row : rows) {
      add_bad_before(row.ray);
      out_.add(std::span(&row, 1));
    }
  }

  const Scene& scene_;
  const CoordinateFrame& frame_;
  const RayTable& table_;
  HitTable& out_;
  const HeightMarchEntry* all_;
  std::size_t materials_;
  const std::optional<CastPart>& part_;
  std::optional<MaxPyramid> pyramid_;  // for all hits
  std::size_t hits_ = 0, below_ = 0;
  std::size_t bad_ = 0;  // bad rays written
  double seconds_ = 0;
};

// A note about the results; empty if they need none. Rays over a `part` of a raster pass over the raster.
std::string finding_of(const Caster& caster, bool any, std::span<const Ray> rays, const Scene& scene,
                       const Places& places, bool part) {
  if (rays.empty()) return "the table of rays has a header alone: 0 rays, and no rows in the output";
  if (any && caster.below() > 0) {
    return fmt::format(
        "{} of {} rays start below ground and never emerge; they are reported as not blocked (without --any: as "
        "'below'); check their heights",
        caster.below(), rays.size());
  }
  if (caster.hits() > 0) return {};
  std::size_t below = caster.below();
  if (any) {
    // Rays from beside the ground are below it where they enter through its border.
    std::vector<Hit> hits(std::min(rays.size(), kPiece));
    scene.closest_hits(rays.first(hits.size()), hits);
    below = static_cast<std::size_t>(
        std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.status == HitStatus::below; }));
  }
  if (below == 0) return part ? "" : place_of(scene, rays, places);
  return fmt::format(
      "nothing was hit: {} of {} rays start below ground, or enter it through its border, and never emerge; check "
      "their "
      "heights",
      below, rays.size());
}

// The input with the mesh of --mesh.
struct WholeInput {
  OpenedInput input;  // its scene is in `scene`
  Places places;
  Scene scene;
  std::vector<std::string> notes;
};

WholeInput open_whole(const CastOptions& options, InputKind kind, const std::optional<CastPart>& part) {
  const MeshInput mesh(options.mesh);
  OpenedInput input = open_input(kind, options);
  for (const std::string& written : {options.output, options.samples}) keep_inputs(written, input.files);
  std::vector<std::string> notes = input.notes;
  Places places = places_of(options, input, part);
  if (kind == InputKind::terrain) {
    if (const std::string note = no_ground_note(*input.scene.only_heights()); !note.empty()) notes.push_back(note);
  }
  stop_if_interrupted();
  Scene scene = mesh.with_mesh(std::move(input.scene), places);
  notes.insert(notes.end(), mesh.notes().begin(), mesh.notes().end());
  return {std::move(input), std::move(places), std::move(scene), std::move(notes)};
}

void run_table(CastOptions options, InputKind kind, const HeightMarchEntry* all) {
  RayTable table = read_rays(options.rays, RayRows::rays, options.skip_bad ? BadRays::left_out : BadRays::refused);
  if (table.lonlat) {
    if (!options.coordinates.empty() && options.coordinates != name_of(Coordinates::lonlat))
      throw Error(fmt::format("{}: has columns lon and lat (leave out --coords {}, or name the columns x and y)",
                              options.rays, options.coordinates));
    options.coordinates = name_of(Coordinates::lonlat);
  }
  const bool terrain = kind == InputKind::terrain && options.mesh.file.empty();
  HitTable out(options.output,
               options.any ? TableKind::blocked
               : terrain   ? TableKind::hits
                           : TableKind::scene_hits,
               table.carried);
  std::optional<TraceTable> samples;
  if (!options.samples.empty()) samples.emplace(options.samples);
  std::optional<CastPart> part;
  if (terrain && options.samples.empty()) part = part_of_rays(options, table, options.coordinates, options.skip_bad);
  CastOptions of_part = options;
  if (part) of_part.part = part->part;
  WholeInput whole = open_whole(of_part, kind, part);
  std::vector<std::string>& notes = whole.notes;
  const Places& places = whole.places;
  const CoordinateFrame& frame = places.frame();
  std::vector<Ray> rays = placed_rays(table, frame, options.skip_bad);
  if (part)
    for (Ray& ray : rays) ray.origin = ray.origin - part->origin;
  for (const std::string& note : check_rays(table, rays, whole.scene, options.skip_bad)) notes.push_back(note);
  stop_if_interrupted();

  if (samples) require_samples(whole.scene);
  const SceneOnDevice there = scene_on_device(options.device, whole.scene);
  const Scene& scene = there.scene;
  const std::string& device = there.device;
  Caster caster(all, scene, whole.input.document ? whole.input.document->materials.size() : 0, frame, table, out, part);
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
  caster.add_bad_before(std::numeric_limits<std::int64_t>::max());
  // The hits become visible last: where they are, the samples are complete.
  if (samples) {
    write_samples(*samples, scene, rays, table, frame);
    samples->commit();
  }
  out.commit();
  if (std::string note = finding_of(caster, options.any, rays, scene, places, part.has_value()); !note.empty())
    notes.push_back(std::move(note));
  print_notes(notes);
  if (::isatty(STDERR_FILENO) != 0) {
    constexpr double kTick_s = 1e-9;  // of the clock: few rays may take less
    fmt::print(stderr, "{} rays, {} {}; {:.3g} s, {:.3g} Mrays/s{}\n", rays.size(), caster.hits(),
               options.any ? "blocked" : "hits", caster.seconds(),
               static_cast<double>(rays.size()) / std::max(caster.seconds(), kTick_s) * 1e-6,
               device.empty() ? "" : ", on " + device);
  }
}

void run_scanner(const CastOptions& options, InputKind kind) {
  check_scan_output(options.scan, options.output);
  ScannerFile scanner = read_scanner(options.scan.scanner);
  keep_inputs(options.output, scanner.files);
  const WholeInput whole = open_whole(options, kind, {});
  const SceneOnDevice there = scene_on_device(options.device, whole.scene);
  run_scan(options.scan, std::move(scanner), {there.scene, whole.places, whole.input.georeference}, options.output,
           whole.notes, there.device);
}

void run(CastOptions options, const Command& command) {
  if (options.output == "-") options.output.clear();
  if (options.rays.empty() && options.scan.scanner.empty())
    throw WrongUsage("--rays FILE or --scanner FILE is required (see 'scarp cast --help')");
  const InputKind kind = kind_of_input(command, options);
  command.require_effect({kind, {}, march_of(options, kind)});
  const HeightMarchEntry* const all = all_hits_of(options);  // refuses before files are read
  validate(options.march_settings);
  keep_apart("--samples", options.samples, options.output, options.typed);
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  // The reader of the table may close the pipe, as `head` does: the program then ends silently, as others do.
  if (options.output.empty()) std::signal(SIGPIPE, SIG_DFL);
  if (options.scan.scanner.empty()) {
    run_table(options, kind, all);
  } else {
    run_scanner(options, kind);
  }
}

}  // namespace

void add_cast(Program& program) {
  Command& command =
      program.add("cast", "Intersect rays of a table with terrain, voxels, a mesh, a scene or a function");
  const auto options = std::make_shared<CastOptions>();
  CastOptions& o = *options;
  add_raster_inputs(command, o.inputs, kEveryFile, false);
  command.add(&o.rays, {.names = "--rays",
                        .value = "FILE",
                        .help = "table of rays: .csv or .npy",
                        .files = "csv npy",
                        .note = "-: CSV from standard input",
                        .fallback = "none",
                        .common = true});
  command.add(&o.skip_bad, {.names = "--skip-bad",
                            .help = "skip rays that cannot be used: their status is 'invalid'",
                            .rules = {needs("--rays FILE", [&o] { return !o.rays.empty(); })}});
  add_scan_options(command, o.scan);
  add_output_option(command, o.output,
                    "table of hits: .csv or .npy; points of a scanner also .ply or .las; -: CSV to standard output",
                    "csv npy ply las", "standard output");
  add_coordinates_option(command, o.coordinates,
                         {.names = "--coords",
                          .help = "coordinates of rays, scanners, hits and --mesh-at",
                          .fallback = "map; local for inputs without a georeference",
                          .common = true});
  command.add(&o.any, {.names = "--any",
                       .help = "occlusion only: columns ray,blocked (1, or 0; 0 also for rays that start below ground)",
                       .common = true,
                       .excludes = {"--scanner"}});
  command.add(&o.all, {.names = "--all",
                       .help = "all hits of each ray in order of t",
                       .common = true,
                       .inputs = {kTerrain, kFirstHit, kFirstHit},
                       .excludes = {"--any", "--mesh", "--scanner"}});
  command.add(&o.samples, {.names = "--samples",
                           .value = "FILE",
                           .help = "table of the steps of each ray's march: .csv",
                           .files = "csv",
                           .writes = true,
                           .fallback = "none",
                           .inputs = {kTerrain | kVoxels | kFunction, "meshes are traced by Embree",
                                      "marches of scenes have several objects"},
                           .excludes = {"--mesh", "--scanner", "--device", "--rounded"}});
  add_march_option(command, o.march);
  add_device_option(command, o.device);
  add_threads_option(command, o.threads);
  add_field_options(command, o.field, BeyondBorders::wraps);
  add_march_options(command, o.march_settings);
  add_mesh_options(command, o.mesh);
  add_vox_options(command, o.vox);
  add_vox_rounding_options(command, o.vox_look);
  add_function_options(command, o.function, {}, o.march, o.march_settings);
  add_raster_options(command, o.raster);
  command.footer(fmt::format("{}\n\n{}", kTables, kSampleColumns));
  command.example("scarp cast dem.tif --rays rays.csv -o hits.csv");
  command.example("scarp cast dem.tif --rays rays.npy --coords local --any -o blocked.npy");
  command.example("scarp cast city.vox --rays rays.csv");
  command.example("scarp cast dem.tif --scanner lidar.json -o points.las");
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
