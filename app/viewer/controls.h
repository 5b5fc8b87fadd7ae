// SPDX-License-Identifier: MIT
// The controls of the panel, generated from the declared options: flags become check boxes, choices lists, numbers
// sliders. A control shows the value of an option, and converts changes to a text for the option. Only options with an
// effect have controls.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/viewer/opening.h"

namespace scarp::viewer {

enum class ControlKind {
  flag,    ///< on or off
  choice,  ///< one of `choices`
  number,  ///< numbers[0]
  pair,    ///< "LOW,HIGH"
  angles,  ///< "AZ,ALT" in degrees
  colour,  ///< "RRGGBB"; numbers are red, green and blue, 0..1
};

struct Control {
  std::string option;  ///< "--no-shadows"
  std::string label;   ///< "shadows"
  std::string help{};  ///< the option's help
  cli::Topic topic = cli::Topic::picture;
  bool common = false;  ///< shown by a plain `--help`
  ControlKind kind = ControlKind::flag;
  bool inverted = false;  ///< a flag that starts with "no-": on means that the option is not given
  bool worded = false;    ///< a flag with the values true and false
  bool on = false;        ///< flags
  bool may_rest = false;  ///< may be unset, with an effect that no value has: no water
  bool rests = false;     ///< currently unset
  bool reset = false;     ///< to be unset: a double click
  bool whole = false;     ///< whole numbers
  bool logarithmic = false;
  double least = 0, most = 1;  ///< ends of the slider
  std::array<double, 3> numbers{};
  std::vector<std::string> choices{};
  std::string choice{};
  std::string unit{};  ///< "m", "\u00b0"; empty: none
  /// The change that unsets it, if that is more than to omit the option.
  std::optional<OptionChange> rest_change{};
};

/// Properties of an input that controls depend on.
struct ControlScales {
  double low = 0, high = 0;               ///< heights in metres, not exaggerated
  double across = 1;                      ///< extent of the picture in metres
  double steps_low = 0, steps_high = 64;  ///< range of the colours of the look `steps`
  double exaggeration = 1;
  std::vector<std::string> marches{};  ///< available for the input; empty: no choice
  std::string march{};                 ///< current march
  bool own_water = false;              ///< whether the input has its own water
  /// Values of options that were not given, where they depend on the input or the look: "--ramp", "viridis".
  std::map<std::string, std::string, std::less<>> in_force{};
};

/// Returns the number that a user typed, with a decimal point or comma; nullopt for any other text.
std::optional<double> typed_number(std::string_view text);

/// The controls of the options that have an effect, in the order of their declarations.
std::vector<Control> controls_of(const Opening& opening, const ControlScales& scales);

/// The change that sets the option to the value of the control.
OptionChange change_of(const Control& control);

}  // namespace scarp::viewer
