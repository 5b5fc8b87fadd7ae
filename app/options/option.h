// SPDX-License-Identifier: MIT
// An option, declared once. Parsing, range checks, compatibility checks, `--help`, doc/user/options.md, man pages and
// shell completion all read this declaration; see Command::add().
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/options/numbers.h"
#include "scarp/base/error.h"

namespace scarp::cli {

/// Thrown if the command line itself is wrong, not the files or data that it names. The text is one line.
class WrongUsage : public Error {
 public:
  using Error::Error;
};

/// Kinds of input. The values are bits of Inputs::kinds.
enum class InputKind : std::uint8_t { terrain = 1, voxels = 2, scene = 4, function = 8, mesh = 16 };
constexpr unsigned kTerrain = 1, kVoxels = 2, kScene = 4, kFunction = 8, kMesh = 16, kEveryInput = 31;
/// "terrain", "voxels", "scene", "function", "mesh".
std::string_view name_of(InputKind kind);

/// Groups of options, in the order in which `--help all` lists them. `--help NAME` lists one.
enum class Topic : std::uint8_t {
  general,
  picture,
  camera,
  light,
  surface,
  ground,
  water,
  fog,
  comanche,
  figure,
  flight,
  depth,
  mesh,
  voxels,
  functions,
  input,
  march,
  window,
  report,
};
constexpr int kTopics = 19;
std::string_view name_of(Topic topic);
std::string_view heading_of(Topic topic);

/// Input kinds that an option applies to, with the reason shown for the rest.
struct Inputs {
  unsigned kinds = kEveryInput;
  std::string_view why{};
  std::string_view why_not_scenes = "a scene file describes its own content";
};

/// The looks that read an option ("shaded comanche"; empty: all), with the reason shown for the rest. Only for inputs
/// in `of`.
struct Looks {
  std::string_view names{};
  std::string_view why{};
  unsigned of = kEveryInput;
};

/// A further condition of an option. `text` continues the sentence that starts with the option's name. Only for inputs
/// in `of`.
struct Rule {
  std::string text;
  std::function<bool()> holds;
  unsigned of = kEveryInput;
};
/// "has no effect without --water M".
Rule needs(const std::string& what, std::function<bool()> met, unsigned of = kEveryInput);

/// Destination of the value. A Setter parses the text itself and throws Error or WrongUsage. bool* without a value
/// name, and Off, are flags.
using Setter = std::function<void(const std::string& text)>;
/// A variable that a flag switches off.
struct Off {
  std::optional<bool>* what;
};
/// Several values in one, "1025,4097". Range and choices apply to each. Given values replace the default.
template <class Value>
struct List {
  std::vector<Value>* to;
};
/// Whole numbers of 64 bits may be written as 1e9. std::vector<std::string>* takes several arguments.
using Binding = std::variant<bool*, Off, int*, std::optional<int>*, std::uint32_t*, std::optional<std::uint32_t>*,
                             std::int64_t*, std::uint64_t*, double*, std::optional<double>*, std::string*,
                             std::vector<std::string>*, List<int>, List<double>, List<std::string>, Setter>;

struct Option {
  std::string names;                    ///< "-o,--output", "--fov"; "IN" for positional arguments
  std::string value{};                  ///< placeholder of the value: "FILE"; empty: by the unit, or a flag
  std::string help{};                   ///< noun phrase without unit, range and default
  std::string unit{};                   ///< "metres"
  NumberRange range{};                  ///< of numbers; checked
  std::vector<std::string> choices{};   ///< allowed words; checked if `closed`
  bool closed = false;                  ///< no other words than `choices`
  bool unlisted = false;                ///< `choices` are too many for the help; only completion lists them
  std::string files{};                  ///< extensions of files, "png exr"; "*": any file
  bool writes = false;                  ///< the files are written, not read
  std::string note{};                   ///< further details: "0: none"
  bool repeats = false;                 ///< for several values: one per mention; otherwise any number
  std::string fallback{};               ///< the default in words; empty: the value of the variable
  std::function<std::string()> now{};   ///< the value set by a Setter, as text; empty: none
  Topic topic = Topic::general;         //
  bool common = false;                  ///< shown by a plain `--help`
  bool required = false;                //
  bool first = false;                   ///< applied before the other options, which override what it sets
  Inputs inputs{};                      ///< checked by require_effect()
  Looks looks{};                        ///< likewise
  std::string_view marches{};           ///< marches that read it, "naive relaxed"; empty: all; likewise
  std::vector<Rule> rules{};            ///< likewise; checked after given options that they mention
  std::vector<std::string> excludes{};  ///< options that cannot be combined with it
};

/// An option with properties derived from its declaration.
struct Declared {
  Option option;
  Binding to;
  std::string name;          ///< the long name, or that of a positional argument
  std::string default_text;  ///< as text; empty: none

  bool flag() const;
  bool positional() const { return !name.starts_with('-'); }
  /// "-o, --output FILE".
  std::string synopsis() const;
  /// "vertical field of view in degrees, 1 to 150".
  std::string meaning() const;
  /// With the default in parentheses.
  std::string description() const;
  /// "terrain; looks shaded and comanche; --march naive; has no effect without --water M"; empty: no restriction.
  std::string restrictions() const;
};

/// Sets the variable. Throws WrongUsage "--fov '0': expected a number from 1 to 150".
void set_value(const Declared& option, const std::string& text);

/// Checks the context of an option. Throws Error if it has no effect there; an empty look or march is not checked.
struct Use {
  InputKind kind = InputKind::terrain;
  std::string_view look{};
  std::string_view march{};
};
void require_effect(const Declared& option, const Use& use);
/// Returns whether require_effect() does not throw.
bool has_effect(const Declared& option, const Use& use);

/// The words of a text with single spaces.
std::vector<std::string_view> words_of(std::string_view text);
/// "a, b and c".
std::string listed(std::span<const std::string_view> words, std::string_view last = "and");

}  // namespace scarp::cli
