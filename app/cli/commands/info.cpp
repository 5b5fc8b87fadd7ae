// SPDX-License-Identifier: MIT
// `scarp info`: describes a raster, a voxel model, a mesh, a scene or a terrain function, as Scarp reads it.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/commands/function_info.h"
#include "app/cli/options/open_input.h"
#include "app/cli/options/raster_options.h"
#include "app/cli/options/scene_input.h"
#include "app/cli/options/shared_options.h"
#include "app/cli/progress.h"
#include "scarp/accel/max_pyramid.h"
#include "scarp/accel/slope_bound.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_raster.h"
#include "scarp/source/raster/map_extent.h"
#include "scarp/source/raster/opened_raster.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions : InputOptions {
  bool json = false;
  bool statistics = false;
};

constexpr double kDegrees = 180 / std::numbers::pi;

Json json_of(const std::optional<MapBounds>& b) { return b ? Json{b->west, b->south, b->east, b->north} : Json(); }

// Bounds of the samples and of the outer edges, in map units and in degrees.
Json extent_of(const Georeference& geo, int cols, int rows) {
  if (!geo.present) return {};
  const MapExtent extent = map_extent(geo, cols, rows);
  return {{"samples", json_of(extent.samples)},
          {"edges", json_of(extent.edges)},
          {"samples_lonlat", json_of(extent.samples_lonlat)},
          {"edges_lonlat", json_of(extent.edges_lonlat)}};
}

// The alternatives of Raster::samples have the order of SampleType.
SampleType sample_type_of(const Raster& raster) { return static_cast<SampleType>(raster.samples.index()); }

// Adds properties of the samples.
void add_statistics(Json& info, Raster raster) {
  std::vector<std::string> notes = std::move(raster.notes);
  const HeightField field = height_field_from(std::move(raster));
  stop_if_interrupted();
  const double samples = static_cast<double>(field.cols()) * field.rows();
  const double sample_bytes = field.sample_type() == SampleType::float32 ? 4 : 2;
  info["nodata_count"] = field.nodata_count();
  info["nodata_share"] = static_cast<double>(field.nodata_count()) / samples;
  info["min_sample"] = field.min_sample();
  info["max_sample"] = field.max_sample();
  info["min_m"] = field.min_height();
  info["max_m"] = field.max_height();
  info["slope_bound"] = slope_bound(field);
  info["sample_type"] = name_of(field.sample_type());
  info["bytes_per_sample"] = sample_bytes + static_cast<double>(MaxPyramid(field).bytes()) / samples;
  if (const std::string note = no_ground_note(field); !note.empty()) notes.push_back(note);
  info["notes"] = notes;
}

// All information in one structure, from which the text and the JSON are generated.
Json describe(const InfoOptions& options) {
  const Progress progress = terminal_progress("read");
  OpenedRaster file(options.inputs, options.raster, progress);
  std::optional<Raster> read;
  if (options.statistics) read = file.read(progress);
  stop_if_interrupted();
  const Raster& raster = read ? *read : file.header();
  const Georeference& geo = raster.georeference;
  Json info;
  info["path"] = raster.path;
  info["kind"] = name_of(InputKind::terrain);
  info["cols"] = raster.cols;
  info["rows"] = raster.rows;
  info["file_type"] = raster.file_type;
  info["crs"] = geo.crs_name.empty() ? Json() : Json(geo.crs_name);
  info["georeferenced"] = geo.present;
  info["map_from_node"] = geo.map_from_node;
  info["bounds"] = extent_of(geo, raster.cols, raster.rows);
  info["cell_size_m"] = {geo.cell_x_m, geo.cell_y_m};
  info["cell_size_found"] = geo.cell_size_found;
  info["grid_north_azimuth_deg"] = geo.grid_north_azimuth * kDegrees;
  info["vertical_unit"] = raster.vertical_unit.empty() ? Json() : Json(raster.vertical_unit);
  info["scale"] = raster.scale;
  info["offset"] = raster.offset;
  info["nodata"] = raster.nodata ? Json(*raster.nodata) : Json();
  info["width_m"] = (raster.cols - 1) * geo.cell_x_m;
  info["depth_m"] = (raster.rows - 1) * geo.cell_y_m;
  info["statistics"] = read ? "samples" : file.stated().low <= file.stated().high ? "file" : "none";
  // Without samples these are unknown, unless the file states them.
  for (const char* key : {"nodata_count", "nodata_share", "min_sample", "max_sample", "min_m", "max_m", "slope_bound"})
    info[key] = Json();
  info["sample_type"] = name_of(sample_type_of(raster));
  info["bytes_per_sample"] = Json();
  info["notes"] = raster.notes;
  if (read) {
    add_statistics(info, std::move(*read));
  } else if (const SampleEnds& stated = file.stated(); stated.low <= stated.high) {
    info["min_sample"] = stated.low;
    info["max_sample"] = stated.high;
    info["min_m"] = stated.low * raster.scale + raster.offset;
    info["max_m"] = stated.high * raster.scale + raster.offset;
  }
  return info;
}

// The lines about the samples.
template <class Line>
void add_sample_lines(const Json& info, const Line& line) {
  const auto number = [&](const char* key) { return info[key].get<double>(); };
  const auto text = [&](const char* key) { return info[key].get<std::string>(); };
  const bool read = info["statistics"] == "samples", stated = info["statistics"] == "file";
  const std::string mark = info["nodata"].is_null() ? "NaN" : fmt::format("{}", number("nodata")),
                    types = fmt::format("{} (in the file {})", text("sample_type"), text("file_type"));
  if (!read) {
    line("nodata", !info["nodata"].is_null()          ? "marked by " + mark
                   : info["sample_type"] == "float32" ? "marked by NaN"
                                                      : "no holes, unless by a mask");
  } else if (info["nodata_count"].get<std::int64_t>() == 0) {
    line("nodata", "no holes");
  } else {
    line("nodata", fmt::format("{} samples ({:.3g} %), marked by {}", info["nodata_count"].get<std::int64_t>(),
                               100 * number("nodata_share"), mark));
  }
  if (read || stated)
    line("heights", fmt::format("{:.6g} to {:.6g} m (samples {:.8g} to {:.8g}{})", number("min_m"), number("max_m"),
                                number("min_sample"), number("max_sample"), stated ? ", as the file states" : ""));
  if (read) {
    line("slope bound",
         fmt::format("{:.4g} ({:.1f} degrees)", number("slope_bound"), std::atan(number("slope_bound")) * kDegrees));
    line("type", fmt::format("{}, {:.2f} bytes each with the pyramid", types, number("bytes_per_sample")));
  } else {
    line("type", types);
    line("statistics", "samples not read (--statistics: heights, holes, slopes)");
  }
}

std::string text_of(const Json& info) {
  const auto number = [&](const char* key) { return info[key].get<double>(); };
  const auto text = [&](const char* key, const char* otherwise) {
    return info[key].is_null() ? otherwise : info[key].get<std::string>();
  };
  std::string out;
  const auto line = [&](std::string_view name, const std::string& value) {
    out += fmt::format("{:<12} {}\n", name, value);
  };
  line("file", text("path", ""));
  line("size", fmt::format("{} x {} samples, {:.6g} x {:.6g} m", info["cols"].get<int>(), info["rows"].get<int>(),
                           number("width_m"), number("depth_m")));
  line("CRS", text("crs", "none"));
  line("cell",
       fmt::format("{:.6g} x {:.6g} m", info["cell_size_m"][0].get<double>(), info["cell_size_m"][1].get<double>()));
  line("", text("cell_size_found", ""));
  if (const Json& bounds = info["bounds"]; !bounds.is_null()) {
    const auto bounds_lines = [&](std::string_view name, const char* key) {
      const auto edges_of = [](const Json& b) {
        const auto at = [&](std::size_t i) { return b[i].get<double>(); };
        // Enough digits for millimetres, in projected units and in degrees.
        return fmt::format("west {:.10g}, south {:.10g}, east {:.10g}, north {:.10g}", at(0), at(1), at(2), at(3));
      };
      const Json &own = bounds[key], &degrees = bounds[std::string(key) + "_lonlat"];
      line(name, edges_of(own) + (own == degrees ? " (degrees)" : ""));
      if (!degrees.is_null() && own != degrees) line("", edges_of(degrees) + " (degrees)");
    };
    bounds_lines("samples", "samples");
    bounds_lines("outer edges", "edges");
  }
  line("units", fmt::format("{}; metres = sample x {:.10g} + {:.10g}",
                            text("vertical_unit", "not stated, metres assumed"), number("scale"), number("offset")));
  add_sample_lines(info, line);
  for (const Json& note : info["notes"]) line("note", note.get<std::string>());
  return out;
}

void run(const InfoOptions& options, const Command& command) {
  const InputKind kind = kind_of_input(command, options);
  command.require_effect({kind});
  const auto print = [&](const Json& info, auto text) {
    // File names may hold any bytes; JSON may not.
    fmt::print("{}", options.json ? info.dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : text(info));
  };
  switch (kind) {
    case InputKind::function:
      return print(describe_function(options.function.function, options.function.extent), function_text_of);
    case InputKind::scene:
      return print(describe_scene(options.inputs.front()), scene_text_of);
    case InputKind::voxels:
      return print(describe_vox(options.inputs.front(), options.vox), vox_text_of);
    case InputKind::mesh:
      return print(describe_mesh(options.inputs.front(), options.mesh), mesh_text_of);
    case InputKind::terrain:
      return print(describe(options), text_of);
  }
}

}  // namespace

void add_info(Program& program) {
  Command& command = program.add("info", "Describe an elevation model, voxels, a mesh, a scene or a terrain function");
  const auto options = std::make_shared<InfoOptions>();
  add_raster_inputs(command, options->inputs, kEveryFile, false);
  add_json_option(command, options->json);
  command.add(&options->statistics, {.names = "--statistics",
                                     .help = "read all samples: heights, holes, slopes, notes about them",
                                     .common = true,
                                     .inputs = {kTerrain, "other inputs are always read completely",
                                                "their terrain is described file by file"}});
  add_function_option(command, options->function, "side of the examined ground about (0, 0)");
  add_raster_options(command, options->raster);
  add_vox_options(command, options->vox);
  add_mesh_up_option(command, options->mesh);
  command.example("scarp info dem.tif");
  command.example("scarp info dem.tif --statistics");
  command.runs([options, &command] { run(*options, command); });
}

}  // namespace scarp::cli
