// SPDX-License-Identifier: MIT
#include "scarp/scene/file/json_object.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scarp/base/error.h"

namespace scarp {
namespace {

// The value, shortened to fit in one line.
std::string shown(const nlohmann::json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  constexpr std::size_t kMost = 60;
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

}  // namespace

void refuse_json(std::string_view path, const nlohmann::json& value, std::string_view expected) {
  throw Error(fmt::format("{}: is {}; expected {}", path.empty() ? "/" : path, shown(value), expected));
}

JsonObject::JsonObject(const nlohmann::json& json, std::string path) : json_(json), path_(std::move(path)) {
  if (!json.is_object()) refuse_json(path_, json, "an object");
}

std::string JsonObject::path_of(std::string_view key) const { return fmt::format("{}/{}", path_, key); }

const nlohmann::json* JsonObject::find(std::string_view key) {
  known_.emplace_back(key);
  const auto found = json_.find(known_.back());
  return found == json_.end() ? nullptr : &*found;
}

const nlohmann::json& JsonObject::at(std::string_view key) {
  const nlohmann::json* value = find(key);
  if (!value) throw Error(fmt::format("{}: is missing", path_of(key)));
  return *value;
}

double JsonObject::number(std::string_view key) {
  const nlohmann::json& value = at(key);
  if (!value.is_number()) refuse_json(path_of(key), value, "a number");
  const auto number = value.get<double>();
  if (!std::isfinite(number)) refuse_json(path_of(key), value, "a finite number");
  return number;
}

double JsonObject::number(std::string_view key, double fallback) {
  return json_.contains(key) ? number(key) : (find(key), fallback);
}

std::int64_t JsonObject::whole(std::string_view key, std::int64_t fallback, std::int64_t least, std::int64_t most) {
  const nlohmann::json* value = find(key);
  if (!value) return fallback;
  const bool fits = value->is_number_integer() &&
                    !(value->is_number_unsigned() && value->get<std::uint64_t>() > std::uint64_t{INT64_MAX});
  const std::int64_t number = fits ? value->get<std::int64_t>() : 0;
  if (!fits || number < least || number > most) {
    refuse_json(path_of(key), *value, fmt::format("a whole number, {} to {}", least, most));
  }
  return number;
}

std::string JsonObject::text(std::string_view key) {
  const nlohmann::json& value = at(key);
  if (!value.is_string()) refuse_json(path_of(key), value, "a text");
  return value.get<std::string>();
}

std::size_t JsonObject::choice(std::string_view key, std::size_t fallback, const std::vector<std::string_view>& names) {
  const nlohmann::json* value = find(key);
  if (!value) return fallback;
  const auto found =
      value->is_string() ? std::find(names.begin(), names.end(), value->get_ref<const std::string&>()) : names.end();
  if (found == names.end()) refuse_json(path_of(key), *value, fmt::format("one of {}", fmt::join(names, ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

void JsonObject::pair(std::string_view key, double& first, double& second) {
  const nlohmann::json* value = find(key);
  if (!value) return;
  const auto good = [](const nlohmann::json& v) { return v.is_number() && std::isfinite(v.get<double>()); };
  if (!value->is_array() || value->size() != 2 || !good((*value)[0]) || !good((*value)[1])) {
    refuse_json(path_of(key), *value, "a list of two finite numbers");
  }
  first = (*value)[0].get<double>(), second = (*value)[1].get<double>();
}

void JsonObject::finish() const {
  for (const auto& [key, value] : json_.items()) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
      constexpr std::size_t kMost = 60;
      throw Error(fmt::format("{}: unknown (available: {})", path_of(key.substr(0, kMost)), fmt::join(known_, ", ")));
    }
  }
}

}  // namespace scarp
