// SPDX-License-Identifier: MIT
// The declarations of the options as JSON. The plugin of QGIS (python/qgis) makes its forms from it.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "app/cli/commands/documents.h"
#include "app/options/help.h"

namespace scarp::cli {
namespace {

using Json = nlohmann::ordered_json;

// The kind of value that a variable holds.
struct ValueKind {
  template <class Number>
  requires std::is_arithmetic_v<Number> std::string_view operator()(Number*) const {
    return std::is_floating_point_v<Number> ? "number" : "integer";
  }
  template <class Value>
  std::string_view operator()(std::optional<Value>*) const {
    return (*this)(static_cast<Value*>(nullptr));
  }
  // Variables of several values, and texts whose setter or subcommand parses them.
  template <class Other>
  std::string_view operator()(const Other&) const {
    return "text";
  }
};

// Limits that only catch typing errors are none, as in the help.
Json json_of(const NumberRange& range) {
  Json out = Json::object();
  if (range.least > -kMostOfGround) {
    out["least"] = range.least;
    if (range.above_least) out["above_least"] = true;
  }
  if (range.most < kMostOfGround) out["most"] = range.most;
  return out;
}

Json json_of(const Declared& one) {
  const Option& option = one.option;
  Json out;
  out["name"] = one.name;
  out["synopsis"] = one.synopsis();
  out["kind"] = one.flag() ? "flag" : std::visit(ValueKind{}, one.to);
  out["help"] = one.meaning();
  out["default"] = one.default_text;
  out["restrictions"] = one.restrictions();
  out["topic"] = name_of(option.topic);
  out["positional"] = one.positional();
  out["required"] = option.required;
  out["common"] = option.common;
  out["repeats"] = option.repeats || std::holds_alternative<std::vector<std::string>*>(one.to);
  out["range"] = json_of(option.range);
  out["choices"] = option.choices;
  out["closed"] = option.closed;
  out["files"] = words_of(option.files);
  out["writes"] = option.writes;
  out["excludes"] = option.excludes;
  out["marches"] = words_of(option.marches);
  out["inputs"] = Json::array();
  for (const InputKind kind :
       {InputKind::terrain, InputKind::voxels, InputKind::scene, InputKind::function, InputKind::mesh}) {
    if ((option.inputs.kinds & static_cast<unsigned>(kind)) != 0) out["inputs"].push_back(name_of(kind));
  }
  return out;
}

}  // namespace

std::string options_json(const Program& program) {
  Json out;
  out["version"] = program.about().version;
  out["subcommands"] = Json::array();
  for (const Command* command : program.commands()) {
    Json one;
    one["name"] = command->name();
    one["summary"] = command->summary();
    one["usage"] = usage_of(*command);
    one["examples"] = command->examples();
    one["notes"] = command->footer();
    one["options"] = Json::array();
    for (const auto& [topic, options] : options_by_topic(*command)) {
      for (const Declared* option : options) one["options"].push_back(json_of(*option));
    }
    out["subcommands"].push_back(std::move(one));
  }
  return out.dump(1, '\t') + "\n";
}

}  // namespace scarp::cli
