// SPDX-License-Identifier: MIT
// `scarp-bench sweeps`: spheres and capsules that move over a height field, compared with Bullet, and random ones over
// rugged small fields and voxels, judged by all triangles.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/bullet_sweep.h"
#include "bench/command.h"
#include "bench/commands.h"
#include "bench/fields.h"
#include "bench/protocol.h"
#include "bench/random.h"
#include "bench/report.h"
#include "bench/sweep_judge.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/height/closest_point.h"
#include "scarp/march/height/ground_contact.h"
#include "scarp/march/voxel/voxel_contact.h"

namespace scarp::bench {
namespace {

// `sweeps`: spheres and capsules that move over ground, compared with Bullet and judged.
struct SweepsOptions {
  int size = 1025;      // samples per side of the field, >= 1025
  int sweeps = 20'000;  // of each class compared with Bullet; 0: none
  int repeats = 5;
  std::int64_t judged = 100'000;  // number of random sweeps over small fields and voxels
  std::uint64_t seed = 1;
};

using Json = nlohmann::ordered_json;

struct Moving {
  Capsule capsule;
  dvec3 motion;
};

HeightField in_metres(const HeightField& field, Surface surface) {
  std::vector<float> samples;
  field.visit([&](const auto& grid) {
    for (int row = 0; row < grid.rows; ++row) {
      for (int col = 0; col < grid.cols; ++col)
        samples.push_back(static_cast<float>(field.height_from_sample(static_cast<double>(grid.at(col, row)))));
    }
  });
  return HeightField::own(std::move(samples), field.cols(), field.rows(), {.surface = surface});
}

struct Class {
  std::string name;
  double radius, height, least, most;  // metres; height: length of a capsule's segment; least, most: of the motion
  bool along;                          // over the ground, not through the air
  int fewer;                           // one in this many: Bullet tests all triangles of a box around the motion
};
const std::vector<Class> kClasses = {{"sphere, step along the ground", 0.5, 0, 0.1, 0.5, true, 1},
                                     {"capsule, step along the ground", 0.4, 1, 0.1, 0.5, true, 1},
                                     {"sphere, thrown 20 m", 0.5, 0, 20, 20, false, 4},
                                     {"sphere, shot 200 m", 0.1, 0, 200, 200, false, 100},
                                     {"capsule, falls 50 m", 0.4, 1, 50, 50, false, 1}};

// Just above the ground, or in the air above it.
std::vector<Moving> sweeps_of(const Class& kind, const HeightField& field, int count, std::uint64_t seed) {
  std::vector<Moving> all;
  for (int i = 0; i < count; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i));
    const double x = random.uniform(300, field.width() - 300), y = random.uniform(300, field.depth() - 300);
    const double reach = random.uniform(kind.least, kind.most), angle = random.uniform(0, 6.283185307);
    Moving moving{{{x, y, 0}, {}, kind.radius}, {}};
    if (kind.along) {
      moving.capsule.a.z = *field.height(x, y) + 1.6 * kind.radius;
      moving.motion = reach * dvec3(std::cos(angle), std::sin(angle), -0.3);
    } else if (kind.height > 0) {
      moving.capsule.a.z = *field.height(x, y) + random.uniform(5, 45);
      moving.motion = {0, 0, -reach};
    } else {
      moving.capsule.a.z = *field.height(x, y) + random.uniform(0.02, 0.3) * reach + 1;
      const double down = random.uniform(-0.8, -0.1), flat = std::sqrt(1 - down * down);
      moving.motion = reach * dvec3(flat * std::cos(angle), flat * std::sin(angle), down);
    }
    moving.capsule.b = moving.capsule.a + dvec3(0, 0, kind.height);
    all.push_back(moving);
  }
  return all;
}

struct Timed {
  double us = 0;
  std::vector<double> t;  // above 1: no contact
};

template <class Sweep>
void time_pass(const std::vector<Moving>& sweeps, const Sweep& sweep, std::vector<double>& us, Timed& to) {
  to.t.clear();
  const Stopwatch watch;
  for (const Moving& moving : sweeps) to.t.push_back(sweep(moving).value_or(2));
  us.push_back(1e6 * watch.cpu_s() / static_cast<double>(sweeps.size()));
}

void measure_beside_bullet(const SweepsOptions& options, Json& rows) {
  FieldOptions ground;
  ground.size = options.size;
  const HeightField field = in_metres(load_field(ground).field, Surface::triangles);
  const MaxPyramid pyramid(field);
  const HeightTarget target{&field, &pyramid};
  const BulletSweeper peer(field);
  std::vector<std::vector<std::string>> lines{
      {"", "sweeps", "Scarp us", "Bullet us", "Bullet / Scarp", "contacts", "Bullet's", "t differs by 0.01"}};
  for (const Class& kind : kClasses) {
    const std::vector<Moving> sweeps = sweeps_of(kind, field, std::max(1, options.sweeps / kind.fewer), options.seed);
    Timed own, other;
    std::vector<double> own_us, other_us;
    for (int i = 0; i <= options.repeats; ++i) {
      time_pass(
          sweeps,
          [&](const Moving& moving) -> std::optional<double> {
            const auto hit = sweep(target, moving.capsule, moving.motion);
            return hit ? std::optional(hit->t) : std::nullopt;
          },
          own_us, own);
      time_pass(
          sweeps, [&](const Moving& moving) { return peer.sweep(moving.capsule, moving.motion); }, other_us, other);
    }
    // The first pass warms up.
    own.us = median({own_us.begin() + 1, own_us.end()}), other.us = median({other_us.begin() + 1, other_us.end()});
    const auto is_contact = [](double t) { return t <= 1; };
    Json row;
    row["class"] = kind.name;
    row["sweeps"] = sweeps.size();
    row["scarp_us"] = own.us;
    row["bullet_us"] = other.us;
    row["ratio"] = other.us / own.us;
    row["contacts"] = std::count_if(own.t.begin(), own.t.end(), is_contact);
    row["bullet_contacts"] = std::count_if(other.t.begin(), other.t.end(), is_contact);
    std::int64_t differ = 0;
    for (std::size_t i = 0; i < own.t.size(); ++i) differ += std::abs(own.t[i] - other.t[i]) > 0.01;
    row["differ"] = differ;
    rows.push_back(row);
    lines.push_back({kind.name, short_number(row["sweeps"], 9), short_number(row["scarp_us"]),
                     short_number(row["bullet_us"]), short_number(row["ratio"]), short_number(row["contacts"], 9),
                     short_number(row["bullet_contacts"], 9), short_number(row["differ"], 9)});
  }
  fmt::print("{} x {} samples, triangles; processor time of one thread per sweep, median of {}\n", options.size,
             options.size, options.repeats);
  print_table(lines, 1);
}

// Contacts of the same bodies with the same samples as triangles and as a bilinear surface.
void compare_surfaces(const SweepsOptions& options, Json& rows) {
  FieldOptions ground;
  ground.size = options.size;
  const HeightField loaded = load_field(ground).field;
  const HeightField triangles = in_metres(loaded, Surface::triangles), bilinear = in_metres(loaded, Surface::bilinear);
  const MaxPyramid own(triangles), other(bilinear);
  const HeightTarget targets[] = {{&triangles, &own}, {&bilinear, &other}};
  std::vector<std::vector<std::string>> lines{{"", "calls", "triangles us", "bilinear us", "ratio"}};
  const auto measure = [&](const std::string& name, const std::vector<Moving>& bodies, const auto& query) {
    std::vector<double> us[2];
    Timed unused;
    for (int i = 0; i <= options.repeats; ++i) {
      for (const int surface : {0, 1}) {
        time_pass(
            bodies, [&](const Moving& moving) { return query(targets[surface], moving); }, us[surface], unused);
      }
    }
    const double first = median({us[0].begin() + 1, us[0].end()}), second = median({us[1].begin() + 1, us[1].end()});
    Json row;
    row["class"] = fmt::format("surfaces: {}", name);
    row["sweeps"] = bodies.size();
    row["triangles_us"] = first;
    row["bilinear_us"] = second;
    row["ratio"] = second / first;
    rows.push_back(row);
    lines.push_back({name, short_number(row["sweeps"], 9), short_number(row["triangles_us"]),
                     short_number(row["bilinear_us"]), short_number(row["ratio"])});
  };
  const auto touch = [](const HeightTarget& target, const Moving& moving) -> std::optional<double> {
    const auto hit = sweep(target, moving.capsule, moving.motion);
    return hit ? std::optional(hit->t) : std::nullopt;
  };
  for (const Class& kind : kClasses)
    measure(kind.name, sweeps_of(kind, triangles, std::max(1, options.sweeps / kind.fewer), options.seed), touch);
  std::vector<Moving> beside = sweeps_of(kClasses[0], triangles, options.sweeps, options.seed);
  measure("box of 1 m that just touches", beside, [](const HeightTarget& target, const Moving& moving) {
    return std::optional(overlaps(target, TurnedBox{moving.capsule.a, dvec3(0.5)}) ? 1.0 : 0.0);
  });
  measure("point 1 m above the ground", beside, [](const HeightTarget& target, const Moving& moving) {
    return std::optional(closest_point(target, moving.capsule.a, 10)->distance);
  });
  fmt::print("{} x {} samples; processor time of one thread per call, median of {}\n", options.size, options.size,
             options.repeats);
  print_table(lines, 1);
}

dvec3 direction(Random& random) {
  for (;;) {
    const dvec3 d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (const double square = dot(d, d); square > 0.01 && square < 1) return normalize(d);
  }
}

// From anywhere to anywhere; half of them at corners, sides, or past a side by the radius.
Moving random_sweep(const dvec3& size, const std::vector<JudgedTriangle>& triangles, Random& random) {
  const auto about = [&] {
    return dvec3(random.uniform(-0.4, 1.4), random.uniform(-0.4, 1.4), random.uniform(-0.4, 1.4)) * size;
  };
  Moving moving{{about(), {}, std::pow(10, random.uniform(-4, 0.3))}, {}};
  moving.capsule.b = moving.capsule.a;
  if (random.below(2)) moving.capsule.b += random.uniform(0, 3) * direction(random);
  moving.motion = about() - moving.capsule.a;
  const int aim = random.below(6);
  if (triangles.empty() || aim > 2) return moving;
  const JudgedTriangle& t = triangles[static_cast<std::size_t>(random.below(static_cast<int>(triangles.size())))];
  dvec3 target = t[0] + (aim == 0 ? 0.0 : random.uniform()) * (t[1] - t[0]);
  if (aim == 2) target += moving.capsule.radius * direction(random);
  moving.motion = (target - moving.capsule.a) * (random.below(2) ? 1.0 : random.uniform(1, 3));
  return moving;
}

constexpr std::int64_t kPerField = 500;

struct Count {
  std::atomic<std::int64_t> sweeps{0}, contacts{0}, tunnelled{0}, untouched{0};
  void add(const Moving& moving, const std::vector<JudgedTriangle>& triangles, const std::optional<double>& t) {
    const JudgedSweep judged{moving.capsule.a, moving.capsule.b, moving.capsule.radius, moving.motion};
    const SweepError error = judge_sweep(judged, triangles, t.has_value(), t.value_or(0), 0);
    ++sweeps;
    contacts += t.has_value();
    tunnelled += error.tunnelled > 0;
    untouched += error.untouched > 0;
  }
};

void judge_field(std::uint64_t seed, std::uint64_t number, std::int64_t count, Count& to) {
  Random random(seed, number);
  const int cols = 2 + random.below(7), rows = 2 + random.below(7);
  const bool holes = random.below(3) == 0;
  std::vector<float> samples;
  for (int i = 0; i < cols * rows; ++i)
    samples.push_back(holes && random.below(5) == 0 ? std::nanf("") : static_cast<float>(random.uniform(-2, 2)));
  const HeightField field = HeightField::own(
      std::move(samples), cols, rows,
      {.cell_x = random.uniform(0.3, 2), .cell_y = random.uniform(0.3, 2), .surface = Surface::triangles});
  const MaxPyramid pyramid(field);
  const auto triangles = all_triangles(field, 1);
  for (std::int64_t i = 0; i < count; ++i) {
    Moving moving = random_sweep({field.width(), field.depth(), 4}, triangles, random);
    moving.capsule.a.z -= 2, moving.capsule.b.z -= 2;
    const auto hit = sweep({&field, &pyramid}, moving.capsule, moving.motion);
    to.add(moving, triangles, hit ? std::optional(hit->t) : std::nullopt);
  }
}

void judge_voxels(std::uint64_t seed, std::uint64_t number, std::int64_t count, Count& to) {
  Random random(seed, number);
  const ivec3 size(1 + random.below(6), 1 + random.below(6), 1 + random.below(6));
  const double share = random.uniform() * random.uniform();
  const VoxelGrid grid = VoxelGrid::built(size, 8, [&](const ivec3& brick, std::span<std::uint32_t, 64>) {
    Random own(seed + 1, number * 64 + static_cast<std::uint64_t>(brick.x + 2 * brick.y + 4 * brick.z));
    std::uint64_t mask = 0;
    for (int i = 0; i < 64; ++i) mask |= std::uint64_t{own.uniform() < share} << i;
    return mask;
  });
  std::vector<JudgedTriangle> triangles;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (!grid.solid({x, y, z})) continue;
        for (int face = 0; face < 6; ++face) {
          dvec3 corner(x, y, z), u(0.0), v(0.0);
          corner[face / 2] += face % 2;
          u[(face / 2 + 1) % 3] = 1, v[(face / 2 + 2) % 3] = 1;
          triangles.push_back({corner, corner + u, corner + v});
          triangles.push_back({corner + u + v, corner + u, corner + v});
        }
      }
    }
  }
  for (std::int64_t i = 0; i < count; ++i) {
    const Moving moving = random_sweep(dvec3(size), triangles, random);
    const auto hit = sweep(grid, moving.capsule, moving.motion);
    // A sweep that starts within a voxel touches immediately, regardless of the distance of its faces.
    if (hit && hit->normal == dvec3(0.0)) {
      ++to.sweeps, ++to.contacts;
      continue;
    }
    to.add(moving, triangles, hit ? std::optional(hit->t) : std::nullopt);
  }
}

// Returns the number of wrong answers.
std::int64_t judge_random(const SweepsOptions& options, Json& rows) {
  if (options.judged == 0) return 0;
  Count heights, voxels;
  const Stopwatch watch;
  const std::int64_t pieces = (options.judged + kPerField - 1) / kPerField;
  parallel_for(pieces, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t piece = begin; piece < end; ++piece) {
      const std::int64_t count = std::min(kPerField, options.judged - piece * kPerField);
      const auto number = static_cast<std::uint64_t>(piece);
      piece % 4 == 3 ? judge_voxels(options.seed, number, count, voxels)
                     : judge_field(options.seed, number, count, heights);
    }
  });
  std::vector<std::vector<std::string>> lines{{"judged", "sweeps", "contacts", "tunnelled", "without a touch"}};
  std::int64_t wrong = 0;
  for (const auto& [name, count] :
       {std::pair<const char*, const Count&>{"height fields, triangles", heights}, {"voxels", voxels}}) {
    Json row;
    row["class"] = fmt::format("judged: {}", name);
    row["sweeps"] = count.sweeps.load();
    row["contacts"] = count.contacts.load();
    row["tunnelled"] = count.tunnelled.load();
    row["untouched"] = count.untouched.load();
    row["seed"] = options.seed;
    wrong += count.tunnelled + count.untouched;
    lines.push_back({name, short_number(row["sweeps"], 9), short_number(row["contacts"], 9),
                     short_number(row["tunnelled"], 9), short_number(row["untouched"], 9)});
    rows.push_back(row);
  }
  print_table(lines, 1);
  fmt::print("{:.0f} s\n", watch.wall_s());
  return wrong;
}

// Throws Error, after the report, if a capsule tunnelled or a contact is false.
void run_sweeps(const SweepsOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  if (options.sweeps > 0) measure_beside_bullet(options, rows);
  if (options.sweeps > 0) compare_surfaces(options, rows);
  const std::int64_t wrong = judge_random(options, rows);
  write_json(report, rows);
  if (wrong > 0) throw Error(fmt::format("sweeps: {} of {} are wrong", wrong, options.judged));
}

}  // namespace

void add_sweeps(cli::Program& program) {
  auto [command, o] = add_command<SweepsOptions>(
      program, "sweeps",
      "Spheres and capsules that move over ground, beside Bullet; random ones, judged by all triangles", run_sweeps);
  command.add(&o.size, {.names = "--size", .help = "samples per side of the field", .range = {1025, 16385}});
  command.add(
      &o.sweeps,
      {.names = "--sweeps", .help = "sweeps of each class beside Bullet", .range = {0, 1e8}, .note = "0: none"});
  add_repeats_option(command, o.repeats, "timed passes");
  command.add(&o.judged, {.names = "--judged", .help = "random sweeps that are judged", .range = {0, 1e12}});
  command.add(&o.seed, {.names = "--seed", .help = "seed of the sweeps"});
}

}  // namespace scarp::bench
