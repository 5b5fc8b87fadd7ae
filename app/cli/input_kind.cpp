// SPDX-License-Identifier: MIT
#include "app/cli/input_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scarp/base/error.h"

namespace scarp::cli {
namespace {

constexpr auto kTerrain = static_cast<unsigned>(InputKind::terrain), kVoxels = static_cast<unsigned>(InputKind::voxels),
               kScene = static_cast<unsigned>(InputKind::scene), kFunction = static_cast<unsigned>(InputKind::function),
               kAll = kTerrain | kVoxels | kScene | kFunction;

struct OptionRow {
  unsigned kinds;
  std::string_view options;  // with a space between them
};

// The same name means the same in every subcommand.
constexpr OptionRow kTable[] = {
    {kAll,
     "IN --output --json --threads --size --look --ramp --sun --no-shadows --samples --sun-size --aa --ao-distance "
     "--seed --haze --error-tolerance --view --eye --target --fov --depth-range --depth-reversed --voxel --count "
     "--within --legend --scale-bar --ground --snow-line --detail --detail-size --contours --water --water-colour "
     "--turbidity --waves --wavelength --no-reflection --no-refraction --fog --visibility --fog-base --fog-falloff "
     "--sun-tint --path --frames --turntable --overwrite --lowres --pixel-size --steps --shells --step-by-view "
     "--iterations --reach --mesh --mesh-at --mesh-scale --mesh-rotate --mesh-up"},
    // A function goes on forever: there is no map of it.
    {kTerrain | kVoxels | kScene, "--top"},
    // Voxels do not run on devices.
    {kTerrain | kScene | kFunction, "--device"},
    // A scene has one for each field in its file.
    {kTerrain | kVoxels | kFunction, "--march"},
    {kTerrain | kFunction,
     "--naive-step-factor --naive-min-step --naive-tolerance --naive-max-steps "
     "--fixed-step --fixed-step-interpolate --fixed-step-max-steps --relaxed-step-factor "
     "--relaxed-tolerance --relaxed-max-steps --shrink --lipschitz-tolerance --lipschitz-max-steps "
     "--local-tolerance --local-max-steps --refine --refine-halvings"},
    {kFunction,
     "--function --extent --preset --function-reach --function-step --function-step-share --function-tolerance"},
    {kVoxels | kScene, "--coarse-voxels"},
    {kVoxels,
     "--frame --hidden --surface-colours --volume --solid-from --up --normals --normal-radius "
     "--rounded --each --corner-ao"},
    {kTerrain, "--bisect-halvings --no-plinth"},
    // Rays of tables.
    {kTerrain, "--rays --any --all --raster-crs"},
    // How a raster is read, and where an overlay lies on it.
    {kTerrain,
     "--band --key --window --nodata --unit --scale --offset --height-range --encoding --raw --channel "
     "--crs --bounds --overlay"},
    {kTerrain, "--exaggeration --surface --wrap --solid"},
};

struct LookRow {
  unsigned kinds;
  std::string_view looks, options;  // with a space between them
};

// What not all looks read. --size and --lowres tell of one another elsewhere.
constexpr LookRow kLookTable[] = {
    {kAll, "shaded", "--no-shadows --sun-size --aa --normals --normal-radius --corner-ao"},
    // Of functions it also says where rays end.
    {kTerrain | kVoxels | kScene, "shaded", "--haze"},
    {kAll, "shaded comanche",
     "--sun --samples --ao-distance --seed --ground --snow-line --detail --detail-size --contours --overlay --water "
     "--water-colour --turbidity --waves --wavelength --no-reflection --no-refraction --fog --visibility --fog-base "
     "--fog-falloff --sun-tint"},
    {kAll, "shaded steps comanche", "--ramp"},
    {kAll, "error", "--error-tolerance"},
    {kAll, "comanche", "--pixel-size --steps --shells --step-by-view --iterations"},
};

std::vector<std::string_view> words_of(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

bool has_word(std::string_view text, std::string_view word) {
  const auto words = words_of(text);
  return std::find(words.begin(), words.end(), word) != words.end();
}

unsigned kinds_of(std::string_view option) {
  for (const auto& [kinds, options] : kTable) {
    if (has_word(options, option)) return kinds;
  }
  return 0;
}

// "the looks shaded, steps and comanche" of "shaded steps comanche".
std::string looks_text(std::string_view looks) {
  const auto words = words_of(looks);
  std::string text = words.size() == 1 ? "the look " : "the looks ";
  for (std::size_t i = 0; i < words.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i + 1 == words.size() ? " and " : ", ", words[i]);
  return text;
}

// "terrain, scenes and functions".
std::string names_of(unsigned kinds) {
  constexpr std::pair<unsigned, std::string_view> kNames[] = {
      {kTerrain, "terrain"}, {kVoxels, "files of voxels"}, {kScene, "scenes"}, {kFunction, "functions"}};
  std::string text;
  for (const auto& [kind, name] : kNames) {
    if ((kinds & kind) == 0) continue;
    kinds &= ~kind;
    text += fmt::format("{}{}", text.empty() ? "" : kinds == 0 ? " and " : ", ", name);
  }
  return text;
}

}  // namespace

std::vector<std::string> given_options(const CLI::App& command) {
  std::vector<std::string> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0) given.push_back(option->get_name());
  }
  return given;
}

bool is_given(const std::vector<std::string>& given, std::string_view option) {
  return std::find(given.begin(), given.end(), option) != given.end();
}

void require_options_of(InputKind kind, const std::vector<std::string>& given) {
  for (const std::string& option : given) {
    const unsigned kinds = kinds_of(option);
    if ((kinds & static_cast<unsigned>(kind)) != 0) continue;
    throw Error(fmt::format("{}: goes with {}; {}leave it out", option, names_of(kinds),
                            kind == InputKind::scene ? "what a scene is made of stands in its file; " : ""));
  }
}

void require_options_of_look(std::string_view look, InputKind kind, const std::vector<std::string>& given) {
  for (const std::string& option : given) {
    for (const auto& [kinds, looks, options] : kLookTable) {
      if ((kinds & static_cast<unsigned>(kind)) == 0 || !has_word(options, option) || has_word(looks, look)) continue;
      throw Error(fmt::format("{}: goes with {}, not with '{}'; leave it out", option, looks_text(looks), look));
    }
  }
}

void require_company(std::initializer_list<Company> rules, const std::vector<std::string>& given) {
  for (const Company& rule : rules) {
    if (rule.there) continue;
    for (const std::string_view option : rule.options) {
      if (is_given(given, option))
        throw Error(fmt::format("{}: has no effect without {}; add that, or leave it out", option, rule.others));
    }
  }
}

}  // namespace scarp::cli
