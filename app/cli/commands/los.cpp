// SPDX-License-Identifier: MIT
// `scarp los`: lines of sight between points of an elevation model.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/bare_ground.h"
#include "app/cli/options/kept_inputs.h"
#include "app/cli/options/map_input.h"
#include "app/cli/options/map_part.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/options/sight_options.h"
#include "app/cli/progress.h"
#include "scarp/analysis/block_maxima.h"
#include "scarp/analysis/line_of_sight.h"
#include "scarp/analysis/sight_parts.h"
#include "scarp/base/csv_text.h"
#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/base/parallel.h"
#include "scarp/source/raster/block_cache.h"
#include "scarp/source/whole_file.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kOutput = R"(Output, one row or line per line of sight:
  line          from 1
  status        with --skip-bad: ok, invalid, outside or nodata; other lines are empty
  visible       1 or 0
  distance      geodesic, metres
  eye,target    heights above sea, metres
  clearance     least height of the line above the ground, metres; negative if blocked
  clearance_at  distance of that point from the observer
  block_x,y     position of the first blocking ground, in --coords
  block_height  height of that ground above sea, metres
  block_at      its distance from the observer
  fresnel       with --frequency: least height of the line above the ground over the radius of the
                first Fresnel zone: 1 if the zone is clear, 0.6 is enough for most links
  fresnel_at    distance of that point from the observer
GeoJSON has longitude and latitude. With --parts each blocked line is two
features, `visible` up to the obstruction and `blocked` beyond it.)";

struct LosOptions : MapOptions {
  SightPlaces places;
  SightHeights heights;
  bool parts = false;
  std::optional<double> frequency;  // megahertz
  std::string bare_ground;
};

struct Answer {
  SightEnds ends;
  LineOfSight line;
  FresnelClearance fresnel{};
};

std::string csv_of(const MapInput& input, const PlaceTable& table, const RowStatus* status,
                   const std::vector<Answer>& answers, bool fresnel) {
  std::string out;
  for (const std::string& name : table.carried.names) append_csv_text(out, name), out += ',';
  out +=
      fmt::format("line,{}visible,distance,eye,target,clearance,clearance_at,block_x,block_y,block_height,block_at{}\n",
                  status ? "status," : "", fresnel ? ",fresnel,fresnel_at" : "");
  for (std::size_t i = 0; i < answers.size(); ++i) {
    for (std::size_t k = 0; k < table.carried.names.size(); ++k)
      append_csv_text(out, table.carried.at(i, k)), out += ',';
    out += fmt::format("{},", i + 1);
    if (status) out += fmt::format("{},", status->of(i));
    if (status && !status->good(i)) {
      out += fresnel ? ",,,,,,,,,,,\n" : ",,,,,,,,,\n";
      continue;
    }
    const LineOfSight& line = answers[i].line;
    out += fmt::format("{:d},{:.10g},{:.10g},{:.10g},", line.visible, line.distance, line.eye, line.target);
    out += std::isfinite(line.clearance)
               ? fmt::format("{:.10g},{:.10g}", line.clearance, line.clearance_along * line.distance)
               : ",";
    if (const auto& block = line.obstruction) {
      const dvec2 point = point_along(answers[i].ends, block->along), at = input.place_of(point.x, point.y);
      out += fmt::format(",{:.10g},{:.10g},{:.10g},{:.10g}", at.x, at.y, block->height, block->along * line.distance);
    } else {
      out += ",,,,";
    }
    const FresnelClearance& zone = answers[i].fresnel;
    if (fresnel)
      out += std::isfinite(zone.share) ? fmt::format(",{:.10g},{:.10g}", zone.share, zone.along * line.distance) : ",,";
    out += '\n';
  }
  return out;
}

std::string geojson_of(const MapInput& input, const PlaceTable& table, const RowStatus* status,
                       const std::vector<Answer>& answers, bool parts, bool fresnel) {
  const auto point = [&](double col, double row, double height) {
    const dvec2 at = input.lonlat_of(col, row).value_or(input.place_of(col, row));
    return Json{at.x, at.y, height};
  };
  Json features = Json::array();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto& [ends, line, zone] = answers[i];
    Json properties;
    for (std::size_t k = 0; k < table.carried.names.size(); ++k)
      properties[table.carried.names[k]] = table.carried.at(i, k);
    properties["line"] = i + 1;
    if (status) properties["status"] = status->of(i);
    if (status && !status->good(i)) {
      features.push_back({{"type", "Feature"}, {"properties", properties}, {"geometry", nullptr}});
      continue;
    }
    properties["visible"] = line.visible;
    properties["distance"] = line.distance;
    properties["eye"] = line.eye;
    properties["target"] = line.target;
    properties["clearance"] = std::isfinite(line.clearance) ? Json(line.clearance) : Json();
    if (fresnel) properties["fresnel"] = std::isfinite(zone.share) ? Json(zone.share) : Json();
    const Json from = point(ends.from.col, ends.from.row, line.eye), to = point(ends.to.col, ends.to.row, line.target);
    const auto add = [&](const Json& a, const Json& b, const Json& all) {
      features.push_back(
          {{"type", "Feature"}, {"properties", all}, {"geometry", {{"type", "LineString"}, {"coordinates", {a, b}}}}});
    };
    if (!line.obstruction) {
      if (parts) properties["part"] = "visible";
      add(from, to, properties);
      continue;
    }
    const Obstruction& block = *line.obstruction;
    const dvec2 blocked = point_along(ends, block.along);
    const Json at = point(blocked.x, blocked.y, block.height);
    properties["block"] = at;
    properties["block_at"] = block.along * line.distance;
    if (!parts) {
      add(from, to, properties);
      continue;
    }
    // The line itself above or below the obstruction: straight between the ends.
    const Json middle = point(blocked.x, blocked.y, line.eye + block.along * (line.target - line.eye));
    properties["part"] = "visible";
    add(from, middle, properties);
    properties["part"] = "blocked";
    add(middle, to, properties);
  }
  return Json{{"type", "FeatureCollection"}, {"features", std::move(features)}}.dump() + "\n";
}

bool is_json(const std::string& output) {
  const std::string extension = extension_of(output);
  return extension == ".geojson" || extension == ".json";
}

constexpr std::string_view kSeaHint = " (heights above sea: --heights, --observer-z)";

// Does the work of a line; errors name the line.
template <class Work>
void of_line(const MapInput& input, const PlaceTable& table, std::size_t i, const Work& work,
             std::string_view hint = {}) {
  try {
    work();
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}{}", table.rows[i].line > 0 ? table.where(i) : input.path(), error.what(), hint));
  }
}

// Heights above sea are the only ones that can be below the ground.
std::string_view hint_for(const SightEnds& ends) {
  return ends.from.datum == HeightDatum::sea || ends.to.datum == HeightDatum::sea ? kSeaHint : "";
}

// Tests lines over the part of the raster that was read.
class Tester {
 public:
  // `many`: whether the lines are so many that structures over the whole part pay off. `frequency`: of the Fresnel
  // zone, in megahertz. `bare`: nullptr if the raster itself is the ground.
  Tester(const MapInput& input, const PlaceTable& table, bool many, std::optional<double> frequency,
         const BareGround* bare)
      : input_(input),
        table_(table),
        frequency_(frequency),
        bare_(bare),
        bilinear_(input.bilinear_ground(input.field())) {
    if (many && !bilinear_) maxima_.emplace(input.field());
  }

  // Places the ends on the ground. Not thread-safe, because messages convert coordinates.
  void stand(std::size_t i, SightEnds& ends) const {
    of_line(input_, table_, i, [&] {
      if (bare_) ends = {bare_->stand_on(ends.from, "observer"), bare_->stand_on(ends.to, "target")};
      require_ground(input_, ends.from, "observer");
      require_ground(input_, ends.to, "target");
    });
  }

  // Thread-safe. `cells` is MapInput::cells_along() for the line.
  void test(std::size_t i, const dvec2& cells, Answer& answer) const {
    const HeightField& field = input_.field();
    const SightEnd from = in_part(input_, answer.ends.from), to = in_part(input_, answer.ends.to);
    of_line(
        input_, table_, i,
        [&] {
          if (!bilinear_) {
            answer.line = line_of_sight(field, from, to, input_.curvature(), maxima_ ? &*maxima_ : nullptr, cells);
            if (frequency_)
              answer.fresnel =
                  fresnel_clearance(SightLine(field, from, to, input_.curvature(), cells), wavelength_of(*frequency_));
          } else {
            answer.line = BilinearGround(with_cells(field, cells), *bilinear_).line_of_sight(from, to);
          }
        },
        hint_for(answer.ends));
  }

 private:
  const MapInput& input_;
  const PlaceTable& table_;
  std::optional<double> frequency_;
  const BareGround* bare_;
  std::optional<BilinearGround> bilinear_;
  std::optional<BlockMaxima> maxima_;
};

dvec2 cells_of(MapInput& input, const SightEnds& ends) {
  return input.cells_along({ends.from.col, ends.from.row}, {ends.to.col, ends.to.row});
}

// Tests lines one after the other. `parts`: what each of them depends on.
void test_one_by_one(MapInput& input, const PlaceTable& table, std::span<const std::size_t> lines, RowStatus& status,
                     std::vector<Answer>& answers, std::span<const RasterWindow> parts, std::optional<double> frequency,
                     BareGround* bare) {
  const Progress progress = terminal_progress("los");
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t i = lines[k];
    input.read(parts[k], {});
    if (bare) bare->follow(input);
    const Tester tester(input, table, false, frequency, bare);
    status.attempt(i, RowStatus::kNodata, [&] { tester.stand(i, answers[i].ends); });
    status.attempt(i, RowStatus::kInvalid, [&] { tester.test(i, cells_of(input, answers[i].ends), answers[i]); });
    if (!progress(static_cast<double>(k + 1) / static_cast<double>(lines.size()))) throw Interrupted();
  }
}

RasterWindow window_of(const NodeRect& nodes) {
  return {nodes.col_begin, nodes.row_begin, nodes.col_end - nodes.col_begin, nodes.row_end - nodes.row_begin};
}

// Tests lines one after the other, each over parts along it.
void test_along(MapInput& input, const PlaceTable& table, std::span<const std::size_t> lines, RowStatus& status,
                std::vector<Answer>& answers, std::optional<double> frequency, BareGround* bare) {
  // Parts share few blocks: GDAL's usual cache would be most of the memory.
  constexpr std::int64_t kBlocks = 16 << 20;
  const BlockCacheLimit few(kBlocks);
  const SightParts parts(input.cols(), input.rows());
  const auto stand = [&](SightEnd& end, std::string_view who) {
    input.read(window_of(parts.around(end)), {});
    if (bare) bare->follow(input), end = bare->stand_on(end, who);
    require_ground(input, end, who);
  };
  const std::optional<double> wavelength = frequency ? std::optional(wavelength_of(*frequency)) : std::nullopt;
  const Progress progress = terminal_progress("los");
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t i = lines[k];
    Answer& one = answers[i];
    SightEnd &from = one.ends.from, &to = one.ends.to;
    status.attempt(i, RowStatus::kNodata,
                   [&] { of_line(input, table, i, [&] { stand(from, "observer"), stand(to, "target"); }); });
    status.attempt(i, RowStatus::kInvalid, [&] {
      const dvec2 cells = cells_of(input, one.ends);
      const auto read = [&](const NodeRect& nodes) {
        input.read(window_of(nodes), {});
        return with_cells(input.field(), cells);
      };
      const auto test = [&] {
        const SightAnswer answer = parts.answer(from, to, input.curvature(), wavelength, read);
        one.line = answer.line, one.fresnel = answer.fresnel;
      };
      of_line(input, table, i, test, hint_for(one.ends));
    });
    if (!progress(static_cast<double>(k + 1) / static_cast<double>(lines.size()))) throw Interrupted();
  }
}

// Whether parts along the lines are better than their boxes. Rays over cells are tested over boxes only.
bool are_long(const MapInput& input, const std::vector<Answer>& answers, std::span<const std::size_t> lines,
              std::span<const RasterWindow> boxes, const std::string& surface) {
  const SightParts parts(input.cols(), input.rows());
  double samples = 0, reads = 0;
  for (const std::size_t i : lines)
    for (const NodeRect& nodes : parts.along(answers[i].ends.from, answers[i].ends.to))
      samples += static_cast<double>(nodes.count()), ++reads;
  return surface == "crossings" && are_wasteful(boxes, samples, reads);
}

void test_lines(MapInput& input, const PlaceTable& table, RowStatus& status, std::vector<Answer>& answers,
                const LosOptions& options, BareGround* bare) {
  const std::optional<double>& frequency = options.frequency;
  std::vector<std::size_t> lines;
  std::vector<RasterWindow> parts;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!status.good(i)) continue;
    lines.push_back(i);
    parts.push_back(part_of_line(input, answers[i].ends.from, answers[i].ends.to));
  }
  if (parts.empty()) return;
  if (are_long(input, answers, lines, parts, options.surface))
    return test_along(input, table, lines, status, answers, frequency, bare);
  if (!read_together(input, parts))
    return test_one_by_one(input, table, lines, status, answers, parts, frequency, bare);
  if (bare) bare->follow(input);
  const Tester tester(input, table, true, frequency, bare);
  std::vector<dvec2> cells(answers.size());
  for (const std::size_t i : lines) {
    status.attempt(i, RowStatus::kNodata, [&] { tester.stand(i, answers[i].ends); });
    status.attempt(i, RowStatus::kInvalid, [&] { cells[i] = cells_of(input, answers[i].ends); });
  }
  constexpr std::int64_t kGrain = 64;
  parallel_for(
      static_cast<std::int64_t>(lines.size()), kGrain,
      [&](std::int64_t begin, std::int64_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
          const std::size_t i = lines[k];
          status.attempt(i, RowStatus::kInvalid, [&] { tester.test(i, cells[i], answers[i]); });
        }
      },
      terminal_progress("los"));
}

void run(LosOptions options, const Command& command) {
  if (options.output == "-") options.output.clear();
  command.require_effect({});
  if (!options.output.empty() && !is_json(options.output) && extension_of(options.output) != ".csv")
    throw Error(fmt::format("output '{}': expected .csv or .geojson", options.output));
  keep_inputs(options.output, options.typed);
  const ThreadLimit limit(options.threads);
  const PlaceTable table = sight_places(options.places);
  if (options.places.pairs) options.heights.target = options.heights.observer;
  MapInput input(options);
  keep_inputs(options.output, input.files());
  std::optional<BareGround> bare;
  if (!options.bare_ground.empty()) bare.emplace(options.bare_ground, options, input);

  input.notes.insert(input.notes.end(), table.notes.begin(), table.notes.end());
  const bool skips = options.places.lines.skip_bad;
  RowStatus status(table, skips);
  const RowStatus* const shown = skips ? &status : nullptr;
  std::vector<Answer> answers(table.rows.size());
  const SightColumns columns(table, options.places.pairs);
  if (const std::string note = note_of_z(options.heights, table); !note.empty()) input.notes.push_back(note);
  for (std::size_t i = 0; i < answers.size(); ++i)
    status.attempt(i, RowStatus::kOutside,
                   [&] { answers[i].ends = sight_ends(input, table, i, options.heights, columns); });
  if (options.surface == "bilinear" && input.curvature().coefficient != 0)
    throw Error("--surface bilinear: its rays are straight (add --cc 0)");
  test_lines(input, table, status, answers, options, bare ? &*bare : nullptr);
  if (const std::string note = status.note(); !note.empty()) input.notes.push_back(note);
  const std::string text = is_json(options.output)
                               ? geojson_of(input, table, shown, answers, options.parts, options.frequency.has_value())
                               : csv_of(input, table, shown, answers, options.frequency.has_value());
  if (options.output.empty()) {
    fmt::print("{}", text);
  } else {
    write_whole_file(options.output, text);
  }
  if (bare) bare->move_notes(input);
  print_notes(input.notes);
  std::size_t visible = 0;
  for (const Answer& one : answers) visible += one.line.visible;
  if (!options.output.empty())
    fmt::print("{}: {} of {} lines visible; {}\n", options.output, visible, answers.size(), input.curvature_text());
}

}  // namespace

void add_los(Program& program) {
  Command& command = program.add("los", "Test lines of sight between points of an elevation model");
  const auto options = std::make_shared<LosOptions>();
  LosOptions& o = *options;
  add_sight_places(command, o.places);
  add_output_option(command, o.output, "result: .csv or .geojson; -: CSV to standard output", "csv geojson",
                    "standard output");
  command.add(&o.parts, {.names = "--parts",
                         .help = "split blocked lines in GeoJSON in two: up to the obstruction, and beyond it",
                         .common = true,
                         .rules = {needs("a .geojson output", [&o] { return is_json(o.output); })}});
  add_sight_heights(command, o.heights);
  add_bare_ground_option(command, o.bare_ground);
  add_observer_z(command, o.heights, "--lines", o.places.lines);
  add_surface_option(command, o.surface);
  add_frequency_option(command, o.frequency, {needs("--surface crossings", [&o] { return o.surface == "crossings"; })});
  add_curvature_option(command, o.curvature);
  add_map_coordinates_option(command, o.coordinates);
  add_map_options(command, o);
  command.footer(kOutput);
  command.example("scarp los dem.tif --from 692000,5143000,2 --to 698500,5149000,10");
  command.example("scarp los dem.tif --lines links.csv --parts -o links.geojson");
  command.example("scarp los dem.tif --lines links.csv --frequency 5800 --k-factor 4/3");
  command.example("scarp los dem.tif --lines towers.csv --pairs --observer-height 20 -o links.csv");
  command.runs([options, &command] {
    options->typed = command.typed_values();
    run(*options, command);
  });
}

}  // namespace scarp::cli
