// SPDX-License-Identifier: MIT
// The slow judge of maps: scarp/analysis/sight.h by brute force, every crossing of every ray, in rational numbers. It
// shares the rounded inputs with the engines (heights, eye, targets, the sun's ray) and no code after that.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <optional>
#include <vector>

#include "scarp/analysis/shadow.h"
#include "scarp/analysis/viewshed.h"

namespace scarp::test {

using Rational = boost::multiprecision::cpp_rational;

/// Whether no crossing strictly between two points blocks the view. Points are in columns and rows, heights are
/// lowered.
bool judge_line(const SightGround& ground, double col, double row, double eye, double to_col, double to_row,
                double target);

/// The code of one node.
Seen judge_seen(const Viewpoint& view, Node node);
std::vector<Seen> judge_viewshed(const HeightField& field, Node observer, const ViewshedSettings& settings);

/// The least visible height of one node, as least_visible() defines it.
double judge_least_visible(const Viewpoint& view, Node node);

/// The code of one node under one sun.
Shade judge_shade(const SightGround& ground, const SunRay& sun, Node node);
std::vector<Shade> judge_shadow(const HeightField& field, const SunDirection& sun);

}  // namespace scarp::test
