// SPDX-License-Identifier: MIT
#include "app/cli/field_options.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "app/cli/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

double exaggeration_from(const std::string& text) {
  constexpr std::string_view kForm = "a number above 0";
  const double number = ground_numbers_from(text, 1, 1, "--exaggeration", kForm).front();
  if (!(number > 0)) throw Error(fmt::format("--exaggeration '{}': expected {}", text, kForm));
  return number;
}

Surface surface_from(const std::string& text) {
  if (text == "bilinear") return Surface::bilinear;
  if (text == "triangles") return Surface::triangles;
  throw Error(fmt::format("--surface '{}': expected bilinear or triangles", text));
}

struct Beyond {
  Wrap wrap = Wrap::none;
  bool mirror = false;
};

Beyond wrap_from(const std::string& text, bool mirrors) {
  if (text == "none") return {};
  if (text == "periodic") return {Wrap::periodic};
  if (text == "shared") return {Wrap::shared_border};
  if (text == "mirror" && mirrors) return {Wrap::periodic, true};
  throw Error(
      fmt::format("--wrap '{}': expected none, periodic{}", text, mirrors ? ", shared or mirror" : " or shared"));
}

}  // namespace

void add_field_options(CLI::App& command, FieldOptions& options, BeyondBorders borders) {
  const std::string group = "Surface";
  const auto add = [&](const char* name, auto& value, auto from, const char* help, const char* otherwise) {
    command
        .add_option_function<std::string>(
            name, [&value, from](const std::string& text) { value = from(text); }, help)
        ->default_str(otherwise)
        ->group(group);
  };
  add("--exaggeration", options.exaggeration, exaggeration_from, "heights times this; above 0", "1");
  add("--surface", options.surface, surface_from, "between the samples: bilinear, or triangles (two per cell)",
      "bilinear");
  if (borders != BeyondBorders::none) {
    const bool mirrors = borders == BeyondBorders::mirrors;
    std::string help =
        "beyond the border: none, periodic (the first column follows the last), shared (the last repeats the first)";
    if (mirrors) help += ", or mirror (the field and its mirror images, without a seam)";
    command
        .add_option_function<std::string>(
            "--wrap",
            [&options, mirrors](const std::string& text) {
              const Beyond beyond = wrap_from(text, mirrors);
              options.wrap = beyond.wrap;
              options.mirror = beyond.mirror;
            },
            help)
        ->default_str("none")
        ->group(group);
  }
  command.add_flag("--solid", options.solid, "rock under the surface: rays hit the walls at borders and holes")
      ->group(group);
}

}  // namespace scarp::cli
