// SPDX-License-Identifier: MIT
// The input of subcommands that compute maps: one elevation model, points on it, and a plane in metres around a point.
// Samples are read in parts (map_part.h). Positions count from the raster's north-west sample, whatever part is read.
#pragma once

#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/options/places.h"
#include "app/options/command.h"
#include "scarp/analysis/bilinear_ground.h"
#include "scarp/analysis/sight.h"
#include "scarp/base/georeference.h"
#include "scarp/field/height_field.h"
#include "scarp/source/raster/metric_plane.h"
#include "scarp/source/raster/opened_raster.h"
#include "scarp/source/raster/raster_options.h"
#include "scarp/source/table/place_table.h"

namespace scarp::cli {

inline constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

/// Keys and texts of a raster's metadata.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Options as typed.
struct MapOptions {
  std::vector<std::string> inputs;
  RasterOptions raster;
  std::string coordinates;          ///< kind of coordinates of places; empty: map, or local without a georeference
  std::optional<double> curvature;  ///< coefficient; empty: depends on the body
  double plane_error = 0.5;         ///< cells
  std::string surface = "crossings";
  int threads = 0;
  std::string output;
  std::vector<std::string> typed;
};

/// Declares IN, --plane-error, --threads and the raster options.
void add_map_options(Command& command, MapOptions& options);
/// Declares --coords, for subcommands with places.
void add_map_coordinates_option(Command& command, std::string& coordinates, std::vector<Rule> rules = {});
/// Declares --cc, and --k-factor, which sets it.
void add_curvature_option(Command& command, std::optional<double>& coefficient);

/// Declares --surface.
void add_surface_option(Command& command, std::string& surface);
/// "bilinear", or a description of `crossings`.
std::string_view surface_text(std::string_view surface);

/// The same samples with other lengths of a column and a row step.
HeightField with_cells(const HeightField& field, const dvec2& cells);

class MapInput {
 public:
  /// Opens the raster without reading samples. Throws Error naming the file.
  explicit MapInput(const MapOptions& options);

  int cols() const { return header_.cols; }
  int rows() const { return header_.rows; }
  RasterWindow whole() const { return {0, 0, cols(), rows()}; }
  /// The middle between the first and the last sample, in columns and rows.
  dvec2 centre() const { return {(cols() - 1) / 2.0, (rows() - 1) / 2.0}; }
  const Georeference& georeference() const { return header_.georeference; }
  /// Properties of the raster, without samples.
  const Raster& header() const { return header_; }
  /// The georeference of a part of the raster, with the cell lengths and azimuth of the whole.
  Georeference georeference_of(const RasterWindow& part) const;
  SampleType sample_type() const { return static_cast<SampleType>(header_.samples.index()); }
  const std::string& path() const { return header_.path; }
  const std::vector<std::string>& files() const { return header_.files; }

  /// Reads a part, which replaces the one read before. Throws Error naming the file, also if the whole raster is read
  /// and is all nodata.
  void read(const RasterWindow& part, const Progress& progress);
  /// Reads the sample nearest to the centre, and returns its height in metres above sea; nullopt on a hole. Before
  /// close(); the part that was read stays. Throws Error naming the file.
  std::optional<double> height_at_centre();
  /// Words for gdalwarp commands in messages, by which pixels that the file does not cover become nodata.
  std::string warp_words() const;
  /// The height in metres that no sample exceeds, whatever the file contains; nullopt for floats.
  std::optional<double> highest_possible() const;
  /// Closes the file, which frees the blocks that GDAL keeps. The samples stay.
  void close() { file_.reset(); }
  /// The part that was read; no samples before the first read().
  const RasterWindow& part() const { return part_; }
  /// The samples of part().
  const HeightField& field() const { return field_; }
  /// Notes for users, printed last.
  std::vector<std::string> notes;

  /// The coefficient of --cc, or by default 6/7 on Earth and 1 on other bodies.
  SightCurvature curvature() const;
  std::string curvature_text() const;
  /// CURVATURE_COEFFICIENT and DIAMETER.
  Metadata curvature_metadata() const;

  /// Position in columns and rows. Messages start with `what`. Places up to half a cell beyond the outermost samples
  /// are moved to these, with a note. Throws Error for a place outside the raster's pixels.
  dvec2 grid_of(const TablePlace& place, bool lonlat, std::string_view what);
  /// The same for a place that may be outside.
  dvec2 position_of(const TablePlace& place, bool lonlat, std::string_view what) const;
  /// A direction in the coordinates of --coords, its height in metres, in metres of the local frame.
  dvec3 direction_of(const dvec3& typed) const;
  /// The sample nearest to a place, as grid_of().
  Node node_of(const TablePlace& place, bool lonlat, std::string_view what) const;
  /// Converts a position in columns and rows to map coordinates, degrees or metres, as --coords specifies.
  dvec2 place_of(double col, double row) const;
  /// Longitude and latitude in degrees; nullopt without a CRS.
  std::optional<dvec2> lonlat_of(double col, double row) const;

  /// field() with the cell lengths at a place. Throws Error if samples within `reach` metres are displaced by more than
  /// --plane-error allows.
  HeightField field_at(double col, double row, double reach);
  /// Azimuth of grid north at a place, in radians, for the longitude of lonlat_of(). Throws as field_at().
  double grid_north_at(double col, double row, double reach);
  /// Lengths in metres of a column and a row step, as those of field_at(). Without a check if `reach` is 0.
  dvec2 cells_at(double col, double row, double reach);
  /// The same along a line, which has its geodesic length with them. Throws Error if samples on the line are displaced
  /// by more than --plane-error allows.
  dvec2 cells_along(const dvec2& from, const dvec2& to);
  /// Geodesic distance in metres between two positions.
  double distance(const dvec2& from, const dvec2& to);

  /// field(), grid north and cell lengths for maps that have one plane, that at the centre. Throws Error as field_at()
  /// for rasters in degrees; projected rasters always have one.
  HeightField whole_field(double reach);
  double whole_grid_north();
  dvec2 whole_cells();
  /// Azimuth of grid north at a place, in radians, for the longitude of lonlat_of(); that of the georeference without a
  /// CRS.
  double north_at(double col, double row) const;
  /// The largest difference of grid north at the corners from that at the centre, in radians; 0 without a CRS.
  double turn_of_north() const;

  /// The ground of --surface bilinear; nullopt for `crossings`. `field` is one of field_at(). Throws Error naming the
  /// file.
  std::optional<BilinearGround> bilinear_ground(const HeightField& field) const;

 private:
  // The frame of longitude and latitude; nullptr without a CRS on Earth. Made when it is first needed, because the
  // search for a transformation takes as long as a small map.
  const CoordinateFrame* find_lonlat() const;
  // nullopt outside the domain of the CRS.
  std::optional<dvec2> find_position(const TablePlace& place, bool lonlat) const;
  // Whether a position is in one of the raster's pixels, which are half open, as in GDAL.
  bool has_pixel(const dvec2& at) const;
  // A question for messages if the raster has a pixel at y,x.
  std::string swapped_hint(const TablePlace& place, bool lonlat) const;
  [[noreturn]] void refuse_outside(const TablePlace& place, bool lonlat, std::string_view what) const;
  const MetricPlanes& planes();
  MetricPlane plane_at(const dvec2& at, double reach);
  // Throws Error if the error of a plane at a place exceeds --plane-error.
  void check_plane(const MetricPlane& plane, const dvec2& at) const;
  void note_plane(const MetricPlane& plane);
  // nullopt without a CRS and outside its domain.
  std::optional<double> find_north(const dvec2& at) const;

  const MapOptions& options_;
  std::optional<OpenedRaster> file_;
  Raster header_;  // without samples
  RasterWindow part_;
  HeightField field_;
  std::size_t notes_of_file_ = 0;  // those in front of `notes`
  Body body_;
  bool geographic_ = false;
  std::optional<CoordinateFrame> frame_;
  mutable std::once_flag lonlat_is_sought_;
  mutable std::optional<CoordinateFrame> lonlat_;
  mutable std::string no_lonlat_;  // why a raster with a CRS has no longitude and latitude on Earth
  std::optional<MetricPlanes> planes_;
  struct CheckedPlane {
    double reach;
    MetricPlane plane;
  };
  std::map<std::pair<double, double>, CheckedPlane> around_;  // by column and row
  bool plane_is_noted_ = false, border_is_noted_ = false;
};

}  // namespace scarp::cli
