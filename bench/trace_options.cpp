// SPDX-License-Identifier: MIT
#include "bench/trace_options.h"
#include "bench/fields.h"

#include <utility>

namespace scarp::bench {

using cli::List;

void add_size_option(cli::Command& command, int& size, const char* help) {
  command.add(&size, {.names = "--size", .help = help, .range = {kLeastSize, kMostSize}});
}

void add_sizes_option(cli::Command& command, std::vector<int>& sizes, const char* help) {
  command.add(List<int>{&sizes}, {.names = "--sizes", .help = help, .range = {kLeastSize, kMostSize}});
}

void add_ground_options(cli::Command& command, FieldOptions& field) {
  command.add(
      &field.kind,
      {.names = "--kind", .value = "KIND", .help = "procedural DEM", .choices = {"ridged", "fbm"}, .closed = true});
  command.add(&field.seed, {.names = "--seed", .help = "seed of the procedural DEM"});
}

void add_repeats_option(cli::Command& command, int& repeats, const char* help) {
  command.add(&repeats, {.names = "--repeats", .help = help, .range = {1, 1000}});
}

void add_pass_limit_option(cli::Command& command, double& seconds, const char* what) {
  command.add(&seconds, {.names = "--pass-limit",
                         .help = "longest pass",
                         .unit = "seconds",
                         .range = cli::kAboveZero,
                         .note = std::string(what) + " that takes longer traces part of the rays"});
}

void add_classes_option(cli::Command& command, std::vector<std::string>& classes, std::vector<std::string> known) {
  command.add(List<std::string>{&classes}, {.names = "--classes",
                                            .help = "classes of rays",
                                            .choices = known.empty() ? classes : std::move(known),
                                            .closed = true});
}

void add_ray_size_option(cli::Command& command, cli::Setter reads, const char* note) {
  command.add(std::move(reads), {.names = "--rays",
                                 .value = "SIZE",
                                 .help = "number of rays",
                                 .choices = {"full", "small"},
                                 .closed = true,
                                 .note = note,
                                 .fallback = "full"});
}

void add_measure_options(cli::Command& command, TraceOptions& trace) {
  command.add(List<int>{&trace.threads}, {.names = "--threads", .help = "numbers of threads", .range = {1, 1024}});
  add_repeats_option(command, trace.repeats, "counted passes per engine");
  command.add(&trace.ray_seed, {.names = "--ray-seed", .help = "seed of the rays"});
  add_pass_limit_option(command, trace.pass_limit_s, "an engine");
  add_ray_size_option(
      command,
      [&trace](const std::string& size) {
        if (size == "small") trace.rays = {160, 88, 4096, 4096, 1024, 32, 128};
      },
      "full: 1920 x 1080 pixels and 2^20 rays for each other class; small: 160 x 88 and 2^12, for tests");
}

void add_trace_options(cli::Command& command, TraceOptions& trace) {
  command.add(&trace.field.dem, {.names = "--dem",
                                 .value = "FILE",
                                 .help = "raster file without holes, instead of a procedural DEM",
                                 .files = "*"});
  add_ground_options(command, trace.field);
  command.add(List<double>{&trace.exaggerations},
              {.names = "--exaggerations", .help = "vertical exaggerations", .range = cli::kAboveZero});
  add_measure_options(command, trace);
  command.add(&trace.judged,
              {.names = "--judged", .help = "rays per class that the judge also traces", .range = {1, 1e8}});
}

void add_field_options(cli::Command& command, TraceOptions& trace) {
  const auto choice = [&](const char* name, std::string& value, const char* help, std::vector<std::string> values) {
    command.add(&value, {.names = name, .value = "NAME", .help = help, .choices = std::move(values), .closed = true});
  };
  choice("--target", trace.instruction_set, "instruction set of Scarp and Embree", {"native", "avx2", "avx512"});
  choice("--samples", trace.field.samples, "sample type of the procedural DEM", {"float32", "int16"});
  choice("--surface", trace.field.surface, "surface of Scarp", {"bilinear", "triangles"});
}

}  // namespace scarp::bench
