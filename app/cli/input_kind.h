// SPDX-License-Identifier: MIT
// Which options go with which inputs and looks, and which with one another: what would have no effect is refused by
// name.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace scarp::cli {

/// What a subcommand was given to work on. The values are bits of the table in input_kind.cpp.
enum class InputKind : std::uint8_t { terrain = 1, voxels = 2, scene = 4, function = 8 };

/// The names of the options that were typed ("--size", "IN").
std::vector<std::string> given_options(const CLI::App& command);
bool is_given(const std::vector<std::string>& given, std::string_view option);

/// Throws Error for the first option that was given and does not go with the kind of input. One that is not in the
/// table goes with none: who adds an option has to say there what it is for.
void require_options_of(InputKind kind, const std::vector<std::string>& given);

/// Throws Error for the first option that was given and that the look does not read, of an input of this kind.
void require_options_of_look(std::string_view look, InputKind kind, const std::vector<std::string>& given);

/// Options that have no effect without another one.
struct Company {
  std::initializer_list<std::string_view> options;
  bool there;               ///< whether the other one was given
  std::string_view others;  ///< "--water M"
};
/// Throws Error for the first option that was given without its company.
void require_company(std::initializer_list<Company> rules, const std::vector<std::string>& given);

}  // namespace scarp::cli
