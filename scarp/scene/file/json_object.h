// SPDX-License-Identifier: MIT
// An object of a JSON file, read key by key. Missing, mistyped and unknown keys are reported with their position in the
// file, as a JSON pointer ("/fields/0/function/octaves").
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scarp {

/// "PATH: is TEXT; expected WHAT" as an Error.
[[noreturn]] void refuse_json(std::string_view path, const nlohmann::json& value, std::string_view expected);

/// Sets `to` if the object has the key. The schema must have checked the type of the value.
template <class T>
void take_json(std::optional<T>& to, const nlohmann::json& object, const char* key) {
  if (object.contains(key)) to = object[key].get<T>();
}

/// Refers to the JSON that it was constructed from.
class JsonObject {
 public:
  /// Throws Error if `json` is not an object.
  JsonObject(const nlohmann::json& json, std::string path);

  const std::string& path() const { return path_; }
  std::string path_of(std::string_view key) const;
  /// Returns null if the key is missing. finish() accepts every key that was requested.
  const nlohmann::json* find(std::string_view key);
  const nlohmann::json& at(std::string_view key);

  /// Returns a finite number, or `fallback` if the key is missing.
  double number(std::string_view key, double fallback);
  double number(std::string_view key);
  std::int64_t whole(std::string_view key, std::int64_t fallback, std::int64_t least, std::int64_t most);
  std::string text(std::string_view key);
  /// Returns the index of the value in `names`.
  std::size_t choice(std::string_view key, std::size_t fallback, const std::vector<std::string_view>& names);
  /// Reads a list of two numbers.
  void pair(std::string_view key, double& first, double& second);

  /// Throws Error for a key that was never requested, listing those that were.
  void finish() const;

 private:
  const nlohmann::json& json_;
  std::string path_;
  std::vector<std::string> known_;
};

}  // namespace scarp
