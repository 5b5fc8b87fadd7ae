// SPDX-License-Identifier: MIT
// `scarp-bench devices`: the Vulkan devices of this machine, and the device that a choice selects.
#include "scarp/vk/device.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/report.h"
#include "scarp/base/error.h"

namespace scarp::bench {
namespace {

// `devices`: the Vulkan devices of this machine. Only with SCARP_VULKAN, like `gpu` and `shaders`.
struct DevicesOptions {
  std::string device = "auto";  // DeviceSettings::choice
};

// Throws Error if there is no device, or none matches the choice.
void run_devices(const DevicesOptions& options) {
  const DeviceList list = list_devices();
  if (list.devices.empty()) throw Error(list.why_none);
  const std::size_t chosen = choose_device(list.devices, options.device);
  std::vector<std::vector<std::string>> lines{{"", "device", "type", "driver", "Vulkan", "memory", "usable"}};
  for (std::size_t i = 0; i < list.devices.size(); ++i) {
    const DeviceDescription& device = list.devices[i];
    lines.push_back({i == chosen ? "*" : "", device.name, std::string(name_of(device.kind)), device.driver,
                     device.api_version,
                     fmt::format("{:.1f} GiB", static_cast<double>(device.memory_bytes) / (1 << 30)),
                     device.usable() ? "yes" : "no: it lacks " + device.missing});
  }
  print_table(lines, lines.front().size());
}

}  // namespace

void add_devices(cli::Program& program) {
  cli::Command& command = program.add("devices", "The Vulkan devices of this machine; *: the chosen one");
  const auto options = std::make_shared<DevicesOptions>();
  command.add(&options->device, {.names = "--device", .value = "NAME", .help = "auto, gpu, cpu or part of a name"});
  command.runs([options] { run_devices(*options); });
}

}  // namespace scarp::bench
