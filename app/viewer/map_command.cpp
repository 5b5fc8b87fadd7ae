// SPDX-License-Identifier: MIT
#include "app/viewer/map_command.h"

#include <string_view>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/options/map_input.h"

namespace scarp::viewer {

std::string raster_words(const cli::Command& view) {
  cli::Program program(cli::about_scarp());
  cli::Command& map = program.add("viewshed", "");
  cli::MapOptions options;
  add_map_options(map, options);
  const std::vector<std::string> given = view.given();
  std::vector<std::string_view> left_out;
  for (const std::string& name : given) {
    if (!map.find(name)) left_out.emplace_back(name);
  }
  return view.typed_words(left_out);
}

}  // namespace scarp::viewer
