// SPDX-License-Identifier: MIT
// The options of every subcommand that builds a surface from a raster.
#pragma once

#include <string>

#include "app/options/command.h"
#include "scarp/scene/file/from_raster.h"

namespace scarp::cli {

/// Ground that a subcommand supports beyond the border of a field: none, periodic wrap, or mirror images as well.
enum class BeyondBorders { none, wraps, mirrors };

/// --exaggeration as typed, in addition to FieldOptions::exaggeration.
struct Exaggeration {
  bool given = false;   ///< a factor, or `auto`
  bool chosen = false;  ///< `auto`: derived from the relief of the raster

  bool operator==(const Exaggeration&) const = default;
};
/// Returns the factor that makes the relief a tenth of the longer side of the ground, both in metres, rounded down to
/// 1, 2 or 5 times a power of ten; at least 1.
double chosen_exaggeration(double relief, double side);
/// Returns a note about ground whose relief is barely visible in pictures; empty if it is visible.
std::string flatness_note(double relief, double side);

/// Returns why every ray misses a field; empty if the field has ground.
std::string no_ground_note(const HeightField& field);

/// Declares --exaggeration, --surface, --solid and, except for `none`, --wrap. Without `exaggeration`, the value auto
/// is rejected.
void add_field_options(Command& command, FieldOptions& options, BeyondBorders borders,
                       Exaggeration* exaggeration = nullptr);

}  // namespace scarp::cli
