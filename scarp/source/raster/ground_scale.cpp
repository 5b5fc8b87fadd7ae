// SPDX-License-Identifier: MIT
#include "scarp/source/raster/ground_scale.h"

#include <fmt/format.h>
#include <proj.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "scarp/base/ellipsoid.h"
#include "scarp/base/error.h"
#include "scarp/base/vec.h"

namespace scarp {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Half the step of the central differences, as a fraction of the ellipsoid's radius (about 950 m on Earth). Using the
// chord causes an error of its square / 6 = 4e-9; iterative inverse projections stop at about 1e-10 radian, an error of
// 7e-7.
constexpr double kStepShare = 1.5e-4;

// A note is added if the axes deviate from a right angle on the ground by more than half a degree.
constexpr double kSkewWorthANote = 0.5 / kDegrees;

struct PjDeleter {
  void operator()(PJ* pj) const { proj_destroy(pj); }
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
using Pj = std::unique_ptr<PJ, PjDeleter>;
using PjContext = std::unique_ptr<PJ_CONTEXT, PjDeleter>;

struct NamedEllipsoid : Ellipsoid {
  std::string name;
};

NamedEllipsoid ellipsoid_of(PJ_CONTEXT* context, const PJ* crs) {
  const Pj ellipsoid(proj_get_ellipsoid(context, crs));
  NamedEllipsoid result;
  double b = 0;
  if (!ellipsoid || !proj_ellipsoid_get_parameters(context, ellipsoid.get(), &result.a, &b, nullptr, nullptr) ||
      !(result.a > 0)) {
    throw Error("the coordinate reference system has no ellipsoid (choose another with --crs)");
  }
  result.e2 = 1 - (b / result.a) * (b / result.a);
  if (const char* name = proj_get_name(ellipsoid.get())) result.name = name;
  return result;
}

// Radians or metres per unit of the first axis.
double axis_unit(PJ_CONTEXT* context, const PJ* crs) {
  const Pj system(proj_crs_get_coordinate_system(context, crs));
  double factor = 0;
  if (!system ||
      !proj_cs_get_axis_info(context, system.get(), 0, nullptr, nullptr, nullptr, &factor, nullptr, nullptr, nullptr) ||
      !(factor > 0)) {
    return 1;
  }
  return factor;
}

GroundScale geographic(PJ_CONTEXT* context, const PJ* crs, double x, double y) {
  const NamedEllipsoid ellipsoid = ellipsoid_of(context, crs);
  const double unit = axis_unit(context, crs), lat = y * unit;
  if (!(std::abs(lat) < std::numbers::pi / 2)) {
    throw Error(fmt::format(
        "the latitude of the centre ({}, {}) is {:.6g} degrees (must be between -90 and 90; correct --crs or "
        "--bounds)",
        x, y, lat * kDegrees));
  }
  GroundScale scale;
  scale.metres_per_x = unit * ellipsoid.prime_vertical_radius(lat) * std::cos(lat);
  scale.metres_per_y = unit * ellipsoid.meridian_radius(lat);
  scale.found = fmt::format("geographic: plane tangent to the {} ellipsoid at the centre's latitude {:.5f}",
                            ellipsoid.name, lat * kDegrees);
  return scale;
}

// A projected CRS, its geographic base, and the transformation from the one to the other.
struct Projection {
  Pj transform;
  NamedEllipsoid ellipsoid;
  double unit = 1;   // metres per map unit
  double angle = 1;  // radians per unit of the base
};

Projection projection_of(PJ_CONTEXT* context, const PJ* crs) {
  const Pj base(proj_crs_get_geodetic_crs(context, crs));
  if (!base) throw Error("the coordinate reference system has no geographic base (choose another with --crs)");
  Projection projection{nullptr, ellipsoid_of(context, base.get()), axis_unit(context, crs),
                        axis_unit(context, base.get())};
  Pj& transform = projection.transform;
  transform.reset(proj_create_crs_to_crs_from_pj(context, crs, base.get(), nullptr, nullptr));
  if (transform) transform.reset(proj_normalize_for_visualization(context, transform.get()));
  if (!transform) {
    throw Error(fmt::format("PROJ cannot invert the projection: {} (choose another CRS with --crs)",
                            proj_context_errno_string(context, proj_context_errno(context))));
  }
  return projection;
}

GroundScale projected(const Projection& projection, double x, double y) {
  const Pj& transform = projection.transform;
  const NamedEllipsoid& ellipsoid = projection.ellipsoid;
  const double unit = projection.unit, angle = projection.angle;
  const auto geographic_at = [&](double map_x, double map_y) {
    const PJ_COORD at = proj_trans(transform.get(), PJ_FWD, proj_coord(map_x, map_y, 0, 0));
    if (!std::isfinite(at.xy.x) || !std::isfinite(at.xy.y)) {
      throw Error(
          fmt::format("the centre ({}, {}) is outside the domain of the projection (correct --crs or --bounds)", x, y));
    }
    return dvec2(at.xy.x * angle, at.xy.y * angle);
  };
  const auto point = [&](double map_x, double map_y) {
    const dvec2 at = geographic_at(map_x, map_y);
    return ellipsoid.point(at.x, at.y);
  };
  const double step = kStepShare * ellipsoid.a / unit;
  const dvec3 along_x = (point(x + step, y) - point(x - step, y)) / (2 * step);
  const dvec3 along_y = (point(x, y + step) - point(x, y - step)) / (2 * step);

  // East and north at the centre, in space.
  const dvec2 centre = geographic_at(x, y);
  const dvec3 east = east_of(centre.x), north = north_of(centre.x, centre.y);

  GroundScale scale;
  scale.metres_per_x = length(along_x);
  scale.metres_per_y = length(along_y);
  if (!(scale.metres_per_x > 0) || !(scale.metres_per_y > 0)) {
    throw Error(fmt::format("the map has no scale at its centre ({}, {}) (correct --crs or --bounds)", x, y));
  }
  scale.grid_north_azimuth = std::atan2(dot(along_y, east), dot(along_y, north));
  const double skew = std::asin(dot(along_x, along_y) / (scale.metres_per_x * scale.metres_per_y));
  if (std::abs(skew) > kSkewWorthANote) {
    scale.notes.push_back(
        fmt::format("columns and rows meet at {:.1f} degrees on the ground at the centre, assuming 90 (gdalwarp to a "
                    "conformal CRS is more accurate)",
                    (std::numbers::pi / 2 - skew) * kDegrees));
  }
  scale.found = fmt::format(
      "projected: PROJ's point scale at the centre {:.6f} along x, {:.6f} along y (map / ground), grid north at "
      "azimuth {:.4f}",
      unit / scale.metres_per_x, unit / scale.metres_per_y,
      std::round(scale.grid_north_azimuth * kDegrees * 1e4) / 1e4 + 0.0);
  if (std::abs(unit - 1) > 0) scale.found += fmt::format(", {} m per map unit", unit);
  return scale;
}

}  // namespace

struct GroundScales::Crs {
  PjContext context;
  Pj crs;
  std::optional<Projection> projection;  // only of projected CRS
};

GroundScales::GroundScales(const std::string& crs) : crs_(std::make_unique<Crs>()) {
  auto& [context, pj, projection] = *crs_;
  context.reset(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  pj.reset(proj_create(context.get(), crs.c_str()));
  // Remove vertical parts and datum shifts: neither affects the length of a map unit.
  for (;;) {
    if (!pj)
      throw Error(
          "PROJ does not know the coordinate reference system (specify one with --crs, for example EPSG:32610)");
    const PJ_TYPE type = proj_get_type(pj.get());
    if (type == PJ_TYPE_COMPOUND_CRS) {
      pj.reset(proj_crs_get_sub_crs(context.get(), pj.get(), 0));
    } else if (type == PJ_TYPE_BOUND_CRS) {
      pj.reset(proj_get_source_crs(context.get(), pj.get()));
    } else {
      break;
    }
  }
  if (proj_get_type(pj.get()) == PJ_TYPE_PROJECTED_CRS) projection = projection_of(context.get(), pj.get());
}

GroundScales::~GroundScales() = default;

GroundScale GroundScales::at(double x, double y) const {
  const auto& [context, pj, projection] = *crs_;
  switch (proj_get_type(pj.get())) {
    case PJ_TYPE_GEOGRAPHIC_2D_CRS:
    case PJ_TYPE_GEOGRAPHIC_3D_CRS:
      return geographic(context.get(), pj.get(), x, y);
    case PJ_TYPE_PROJECTED_CRS:
      return projected(*projection, x, y);
    case PJ_TYPE_ENGINEERING_CRS: {
      GroundScale scale;
      scale.metres_per_x = scale.metres_per_y = axis_unit(context.get(), pj.get());
      scale.found =
          fmt::format("local coordinate system: {} m per unit, assuming that north is up", scale.metres_per_x);
      return scale;
    }
    default:
      break;
  }
  throw Error("the coordinate reference system is neither geographic nor projected (choose another with --crs)");
}

std::shared_ptr<const GroundScales> ground_scales_of(const std::string& crs) {
  // To read a CRS costs milliseconds, and most programs have one.
  thread_local std::pair<std::string, std::shared_ptr<const GroundScales>> last;
  if (!last.second || last.first != crs) last = {crs, std::make_shared<const GroundScales>(crs)};
  return last.second;
}

GroundScale ground_scale_at(const std::string& crs, double x, double y) { return ground_scales_of(crs)->at(x, y); }

}  // namespace scarp
