// SPDX-License-Identifier: MIT
#include "scarp/scene/file/scene_schema.h"

// g++ 12 falsely warns of overlaps in "[" + std::to_string(index), which valijson uses often (GCC bug 105651).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wrestrict"
#endif

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "scarp/base/error.h"
#include "scarp/base/input_file.h"
#include "scarp/scene/file/json_object.h"
#include "scarp/source/incomplete_file.h"

namespace scarp {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostShown = 60;  // characters of a position or a name

std::string shortened(const std::string& text) {
  return text.size() <= kMostShown ? text : text.substr(0, kMostShown) + "...";
}

// One level of the containers that the parser is in.
struct Level {
  bool list;
  std::size_t index = 0;         // position in a list
  std::string key{};             // current key of an object
  std::set<std::string> keys{};  // keys so far
};

std::string pointer(const std::vector<Level>& levels) {
  std::string path;
  for (const Level& level : levels) {
    path.append("/").append(level.list ? std::to_string(level.index) : level.key);
    if (path.size() > kMostShown) return shortened(path);
  }
  return path;
}

// The part of the schema for a position in the file; null if there is none.
class SchemaWalk {
 public:
  explicit SchemaWalk(const Json& schema) : schema_(schema), here_(&schema) {}

  void enter(const std::string& step) {
    if (!here_) return;
    const Json* next = nullptr;
    if (const auto properties = here_->find("properties"); properties != here_->end() && properties->contains(step)) {
      next = &(*properties)[step];
    } else if (here_->contains("items")) {
      next = &(*here_)["items"];
    } else if (here_->contains("additionalProperties") && (*here_)["additionalProperties"].is_object()) {
      next = &(*here_)["additionalProperties"];
    }
    if (next && next->contains("$ref")) {
      const std::string reference = (*next)["$ref"];
      next = &schema_.at(Json::json_pointer(reference.substr(1)));
    }
    here_ = next;
  }
  std::string expected() const {
    return here_ && here_->contains("description") ? (*here_)["description"].get<std::string>() : "something else";
  }
  std::string keys() const {
    std::string keys;
    if (!here_ || !here_->contains("properties")) return keys;
    for (const auto& [key, value] : (*here_)["properties"].items()) keys += (keys.empty() ? "" : ", ") + key;
    return keys;
  }

 private:
  const Json& schema_;
  const Json* here_;
};

[[noreturn]] void refuse(const Json& scene, const Json& schema, const valijson::ValidationResults::Error& error) {
  SchemaWalk walk(schema);
  const Json* here = &scene;
  std::string path;
  for (std::size_t i = 1; i < error.context.size(); ++i) {
    const std::string step = error.context[i].substr(1, error.context[i].size() - 2);  // "[step]"
    path.append("/").append(step);
    here = here->is_array() ? &(*here)[std::stoul(step)] : &(*here)[step];
    walk.enter(step);
  }
  const auto quoted = [&]() {
    const std::size_t begin = error.description.find('\'') + 1;
    // The message ends with the name, its quote and a full stop.
    return error.description.substr(begin, error.description.size() - 2 - begin);
  };
  if (error.description.starts_with("Missing required property") ||
      error.description.starts_with("Missing dependency")) {
    const std::string key = quoted();
    walk.enter(key);
    throw Error(fmt::format("{}/{}: is missing; expected {}", shortened(path), key, walk.expected()));
  }
  if (error.description.starts_with("Object contains a property")) {
    for (const auto& [key, value] : here->items()) {
      SchemaWalk inner = walk;
      inner.enter(key);
      if (!inner.expected().starts_with("something else")) continue;
      throw Error(fmt::format("{}/{}: unknown (available: {})", shortened(path), shortened(key), walk.keys()));
    }
  }
  refuse_json(shortened(path), *here, walk.expected());
}

}  // namespace

std::string json_text_of(const std::string& path, std::string_view what) {
  if (std::filesystem::is_directory(path)) throw Error(fmt::format("is a folder; give the file of {}", what));
  refuse_special_file(path);
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file && !file.eof()) throw Error("cannot be read; is it there?");
  refuse_lfs_pointer(text);
  return text;
}

Json parse_scene_text(std::string_view text) {
  std::vector<Level> levels;
  const auto look = [&](int, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    switch (event) {
      case Event::object_start:
      case Event::array_start:
        if (levels.size() == kDeepestScene) {
          throw Error(fmt::format("{}: more levels within one another than the {} that there may be", pointer(levels),
                                  kDeepestScene));
        }
        levels.push_back({event == Event::array_start});
        break;
      case Event::key:
        levels.back().key = parsed.get<std::string>();
        if (!levels.back().keys.insert(levels.back().key).second)
          throw Error(fmt::format("{}: is there twice; give it once", pointer(levels)));
        break;
      case Event::object_end:
      case Event::array_end:
        levels.pop_back();
        [[fallthrough]];
      case Event::value:
        if (!levels.empty() && levels.back().list) ++levels.back().index;
    }
    return true;
  };
  try {
    return Json::parse(text, look);
  } catch (const Json::out_of_range& error) {
    // "[json.exception.out_of_range.406] number overflow parsing '1e999'"
    const std::string_view what = error.what(), number = what.substr(std::min(what.find('\''), what.size()));
    throw Error(fmt::format("{}: the number {} is too large; there are none beyond 1.8e308", pointer(levels), number));
  } catch (const Json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
    std::string_view what = error.what();
    if (const std::size_t end = what.find("] "); end != std::string_view::npos) what.remove_prefix(end + 2);
    throw Error(fmt::format("no JSON: {}", what));
  }
}

void check_scene_schema(const Json& scene) {
  static const Json schema_json = Json::parse(scene_schema_text());
  static const auto schema = [] {
    auto made = std::make_unique<valijson::Schema>();
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_json), *made);
    return made;
  }();
  valijson::ValidationResults results;
  if (valijson::Validator().validate(*schema, valijson::adapters::NlohmannJsonAdapter(scene), &results)) return;
  // Errors in nested values are reported first.
  refuse(scene, schema_json, *results.begin());
}

}  // namespace scarp
