// SPDX-License-Identifier: MIT
// `scarp devices`: the Vulkan devices of this machine, and whether Scarp can compute on them.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/cli/commands.h"
#include "app/cli/options/shared_options.h"
#include "scarp/vk/device.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

double gibibytes(std::uint64_t bytes) { return static_cast<double>(bytes) / (1ull << 30); }

Json json_of(const DeviceDescription& device) {
  Json json;
  json["name"] = device.name;
  json["type"] = name_of(device.kind);
  json["driver"] = device.driver;
  json["vulkan"] = device.api_version;
  json["memory_bytes"] = device.memory_bytes;
  json["max_allocation_bytes"] = device.max_allocation_bytes;
  json["max_storage_range"] = device.max_storage_range;
  json["max_workgroup_invocations"] = device.max_workgroup_invocations;
  json["shared_memory_bytes"] = device.shared_memory_bytes;
  json["subgroup_size"] = device.subgroup_size;
  json["float64"] = device.abilities.float64;
  json["int64"] = device.abilities.int64;
  json["timestamps"] = device.abilities.timestamps;
  json["usable"] = device.usable();
  json["missing"] = device.missing;
  return json;
}

std::string text_of(const DeviceDescription& device) {
  std::string text = fmt::format("{}\n", device.name);
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("    {:<10} {}\n", name, value);
  };
  line("type", std::string(name_of(device.kind)));
  line("driver", device.driver);
  line("Vulkan", device.api_version);
  line("memory", fmt::format("{:.1f} GiB, {:.1f} GiB in one buffer", gibibytes(device.memory_bytes),
                             gibibytes(device.max_allocation_bytes)));
  line("workgroup", fmt::format("{} invocations, {} KiB shared, subgroups of {}", device.max_workgroup_invocations,
                                device.shared_memory_bytes / 1024, device.subgroup_size));
  line("has", fmt::format("timestamps: {}, 64-bit floats: {}", device.abilities.timestamps ? "yes" : "no",
                          device.abilities.float64 ? "yes" : "no"));
  line("usable", device.usable() ? "yes" : "no: it lacks " + device.missing);
  return text;
}

}  // namespace

void add_devices(Program& program) {
  Command& command = program.add("devices", "List the Vulkan devices and whether scarp can compute on them");
  const auto json = std::make_shared<bool>(false);
  add_json_option(command, *json);
  command.runs([json] {
    const DeviceList list = list_devices();
    if (*json) {
      Json all;
      all["devices"] = Json::array();
      for (const DeviceDescription& device : list.devices) all["devices"].push_back(json_of(device));
      all["why_none"] = list.why_none;
      fmt::print("{}\n", all.dump(2, ' ', false, Json::error_handler_t::replace));
      return;
    }
    for (const DeviceDescription& device : list.devices) fmt::print("{}", text_of(device));
    if (list.devices.empty()) fmt::print("no device: {}\n", list.why_none);
  });
}

}  // namespace scarp::cli
