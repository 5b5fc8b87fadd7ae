// SPDX-License-Identifier: MIT
#include "app/viewer/opening.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "app/cli/kept_inputs.h"
#include "app/cli/render_settle.h"

namespace scarp::viewer {
namespace {

// A slider goes from a fraction of the default to a multiple of it.
constexpr double kSpan = 64;

bool reads(const cli::Option& option, std::string_view march) {
  std::istringstream names{std::string(option.marches)};
  for (std::string name; names >> name;) {
    if (name == march) return true;
  }
  return false;
}

double value_of(const MarchParameter& parameter) {
  return std::visit([](auto* to) { return static_cast<double>(*to); }, parameter.to);
}

MarchParameter parameter_of(const cli::Declared& declared, std::variant<int*, double*> to) {
  const cli::Option& option = declared.option;
  // Not the value that it has: sliders stay as they are while they move.
  const double usual = declared.default_text.empty() ? 0 : std::atof(declared.default_text.c_str());
  const bool whole = std::holds_alternative<int*>(to);
  double least = whole ? std::floor(usual / kSpan) : usual / kSpan;
  double most = usual > 0 ? kSpan * usual : 1;
  least = std::max(least, option.range.above_least ? most / (kSpan * kSpan * kSpan) : option.range.least);
  most = std::min(most, option.range.most);
  return {declared.name.substr(2), option.help, to, least, most};
}

// What the window writes is none of what it reads.
void keep_inputs(const cli::ViewOptions& options) {
  for (const std::string& output : {options.record, options.screenshot, options.timings}) {
    std::vector<std::string> others = options.typed;
    if (const auto own = std::find(others.begin(), others.end(), output); own != others.end()) others.erase(own);
    if (!output.empty()) cli::keep_inputs(output, others);
  }
}

}  // namespace

Opening settle_opening(std::shared_ptr<cli::Program> program, std::shared_ptr<cli::ViewOptions> options,
                       const cli::Command& command) {
  cli::ViewOptions& o = *options;
  o.moves = true;
  o.given = command.given();
  o.typed = command.typed_values();
  std::vector<std::string_view> left_out = cli::kWindowOptions;
  for (const cli::Declared& declared : command.options()) {
    if (declared.option.topic == cli::Topic::march && !declared.option.marches.empty() &&
        (std::holds_alternative<int*>(declared.to) || std::holds_alternative<double*>(declared.to)))
      left_out.push_back(declared.name);
  }
  o.words = command.typed_words(left_out);
  const cli::InputKind kind = cli::kind_of_input(command, o);
  command.require_effect({kind, o.look, cli::march_of(o, kind)});
  const ViewSettings view = cli::settle_picture(o);
  cli::require_places(o);
  keep_inputs(o);
  return {std::move(program), std::move(options), kind, view};
}

Opening opening_of(const std::string& file) {
  auto program = std::make_shared<cli::Program>();
  auto options = std::make_shared<cli::ViewOptions>();
  cli::Command& command = declare_view(*program, *options);
  command.runs([] {});
  std::string name = "scarp", view = "view", input = file;
  char* words[] = {name.data(), view.data(), input.data()};
  program->run(3, words);
  return settle_opening(std::move(program), std::move(options), command);
}

std::vector<MarchParameter> parameters_of(const Opening& opening, std::string_view march) {
  std::vector<MarchParameter> found;
  for (const cli::Declared& declared : opening.program->find("view")->options()) {
    const cli::Option& option = declared.option;
    if (option.topic != cli::Topic::march || !reads(option, march)) continue;
    if ((option.inputs.kinds & static_cast<unsigned>(opening.kind)) == 0) continue;
    if (int* const* whole = std::get_if<int*>(&declared.to)) found.push_back(parameter_of(declared, *whole));
    if (double* const* number = std::get_if<double*>(&declared.to)) found.push_back(parameter_of(declared, *number));
  }
  return found;
}

std::string parameter_words(const Opening& opening, std::string_view march) {
  std::string words;
  for (const MarchParameter& parameter : parameters_of(opening, march)) {
    const cli::Declared* declared = opening.program->find("view")->find("--" + parameter.name);
    const std::string value = fmt::format("{:.17g}", value_of(parameter));
    if (std::atof(declared->default_text.c_str()) != value_of(parameter)) words += " --" + parameter.name + "=" + value;
  }
  return words;
}

}  // namespace scarp::viewer
