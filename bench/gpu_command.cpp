// SPDX-License-Identifier: MIT
#include "bench/gpu_command.h"

#include <string>

#include "app/cli/numbers.h"

namespace scarp::bench {

using cli::kAboveZero, cli::number_in;

CLI::App* add_devices_command(CLI::App& app, DevicesOptions& options) {
  CLI::App* command =
      app.add_subcommand("devices", "the Vulkan devices of this machine, one per line; *: the chosen one");
  command->add_option("--device", options.device, "auto, gpu, cpu or part of a name")->capture_default_str();
  return command;
}

CLI::App* add_gpu_command(CLI::App& app, GpuOptions& gpu) {
  CLI::App* gpu_command =
      app.add_subcommand("gpu", "the marches on a Vulkan device, and the article's comparison there");
  gpu_command->add_option("--device", gpu.device, "auto, gpu, cpu or part of a name")->capture_default_str();
  gpu_command
      ->add_option("--sizes", gpu.sizes,
                   "samples per side of the procedural DEM, one or several (1025,4097, and 16385 but for CPU devices)")
      ->delimiter(',')
      ->check(CLI::Range(kLeastSize, kMostSize));
  gpu_command->add_option("--kind", gpu.field.kind, "procedural DEM")
      ->check(CLI::IsMember({"ridged", "fbm"}))
      ->capture_default_str();
  gpu_command->add_option("--classes", gpu.classes, "of rays")
      ->delimiter(',')
      ->check(CLI::IsMember(gpu.classes))
      ->capture_default_str();
  gpu_command->add_option("--exaggerations", gpu.exaggerations, "vertical, one or several")
      ->delimiter(',')
      ->check(number_in(kAboveZero))
      ->capture_default_str();
  gpu_command->add_option("--seed", gpu.field.seed, "of the procedural DEM")->capture_default_str();
  gpu_command->add_option("--ray-seed", gpu.ray_seed, "of the rays")->capture_default_str();
  gpu_command
      ->add_option_function<std::string>(
          "--rays",
          [&gpu](const std::string& size) {
            gpu.rays = size == "small" ? RayCounts{160, 88, 4096, 4096, 64} : RayCounts{};
          },
          "full: 1920 x 1080 pixels and 2^20 rays for each other class (but for CPU devices: a sixteenth); small: "
          "160 x 88 and 2^12, to see that all works")
      ->check(CLI::IsMember({"full", "small"}));
  gpu_command
      ->add_option("--judged", gpu.judged, "rays per class that the oracle answers, too (20000; for CPU devices 4096)")
      ->check(CLI::Range(1, 100'000'000));
  gpu_command->add_option("--miss-limit", gpu.miss_limit, "share of the hits that naive-missed may miss")
      ->check(number_in({0, 1}))
      ->capture_default_str();
  gpu_command->add_option("--repeats", gpu.repeats, "counted passes per march")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  gpu_command
      ->add_option("--pass-limit", gpu.pass_limit_s,
                   "seconds; a march that takes longer for a pass traces part of the rays")
      ->check(number_in(kAboveZero))
      ->capture_default_str();
  gpu_command->add_flag("--raster", gpu.raster,
                        "instead: primary rays beside the same grid drawn as two triangles per cell");
  return gpu_command;
}

}  // namespace scarp::bench
