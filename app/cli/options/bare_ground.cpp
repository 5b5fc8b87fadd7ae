// SPDX-License-Identifier: MIT
#include "app/cli/options/bare_ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/cli/options/map_part.h"
#include "app/cli/progress.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

MapOptions options_for(const std::string& path, MapOptions options) {
  options.inputs = {path};
  return options;
}

// Whether the samples are at the same places, to a thousandth of a cell.
bool same_places(const MapInput& a, const MapInput& b) {
  if (a.cols() != b.cols() || a.rows() != b.rows() || a.georeference().present != b.georeference().present)
    return false;
  const auto &m = a.georeference().map_from_node, &n = b.georeference().map_from_node;
  const auto far = [](double x, double y, double cell) { return !(std::abs(x - y) <= 1e-3 * std::abs(cell)); };
  const auto corner = [](const auto& t, int axis, int steps) {
    const std::size_t at = axis == 0 ? 0 : 3, step = axis == 0 ? 1 : 5;
    return t[at] + steps * t[step];
  };
  return !far(m[0], n[0], m[1]) && !far(m[3], n[3], m[5]) &&
         !far(corner(m, 0, a.cols()), corner(n, 0, a.cols()), m[1]) &&
         !far(corner(m, 1, a.rows()), corner(n, 1, a.rows()), m[5]);
}

}  // namespace

void add_bare_ground_option(Command& command, std::string& path, std::vector<std::string> excludes) {
  command.add(&path, {.names = "--ground",
                      .value = "FILE",
                      .help = "bare ground below the surface IN: observers and targets stand on it, IN hides them",
                      .files = "*",
                      .note = "with the samples of IN",
                      .fallback = "IN",
                      .common = true,
                      .excludes = std::move(excludes)});
}

BareGround::BareGround(const std::string& path, const MapOptions& options, const MapInput& surface)
    : options_(options_for(path, options)), input_(options_) {
  if (same_places(input_, surface)) return;
  const auto& map = surface.georeference().map_from_node;
  const double west = map[0] - 0.5 * map[1], north = map[3] - 0.5 * map[5];
  throw Error(fmt::format(
      "--ground '{}': its {} x {} samples are not at the places of the {} x {} of {} (first: gdalwarp -te {:.10g} "
      "{:.10g} {:.10g} {:.10g} -ts {} {} -r bilinear{} {} ground.tif)",
      path, input_.cols(), input_.rows(), surface.cols(), surface.rows(), surface.path(), west,
      north + surface.rows() * map[5], west + surface.cols() * map[1], north, surface.cols(), surface.rows(),
      input_.warp_words(), path));
}

void BareGround::follow(const MapInput& surface) {
  if (input_.part() == surface.part()) return;
  input_.read(surface.part(), terminal_progress("read"));
}

void BareGround::move_notes(MapInput& surface) {
  for (const std::string& note : std::exchange(input_.notes, {}))
    if (std::find(surface.notes.begin(), surface.notes.end(), note) == surface.notes.end())
      surface.notes.push_back(note);
}

std::optional<double> BareGround::height_at(const dvec2& at) const {
  const SightEnd here = in_part(input_, SightEnd{at.x, at.y});
  return SightGround(input_.field()).height_at(here.col, here.row);
}

SightEnd BareGround::stand_on(SightEnd end, std::string_view who) const {
  end.under_surface = true;
  if (end.datum == HeightDatum::sea) return end;
  const auto height = height_at({rounded_end(end.col), rounded_end(end.row)});
  if (!height) {
    const dvec2 at = input_.place_of(end.col, end.row);
    throw Error(fmt::format("{}: {:.10g},{:.10g} is on nodata of {} (give its height above sea: --heights sea)", who,
                            at.x, at.y, input_.path()));
  }
  end.height += *height;
  end.datum = HeightDatum::sea;
  return end;
}

}  // namespace scarp::cli
