// SPDX-License-Identifier: MIT
#include "scarp/scene/file/ray_dump.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "scarp/base/error.h"
#include "scarp/base/input_file.h"
#include "scarp/base/replace_file.h"
#include "scarp/march/height/queries.h"

namespace scarp {
namespace {

// Maximum number of samples of a generated field: 4 GiB. The largest field of scarp-bench leaks fits, and a line of a
// file cannot allocate all memory.
constexpr std::int64_t kMostGenerated = std::int64_t{1} << 30;

constexpr std::string_view kHead = "scarp-rays 1";

std::string_view name_of(Surface surface) { return surface == Surface::bilinear ? "bilinear" : "triangles"; }
std::string_view name_of(Wrap wrap) {
  return wrap == Wrap::none ? "none" : wrap == Wrap::periodic ? "periodic" : "shared_border";
}

std::string text_of(const RayDump& dump) {
  const HeightField& field = dump.field;
  const HeightFieldSettings& to = field.settings();
  std::string text = fmt::format("\nfield {} {} {}\n", scarp::name_of(field.sample_type()), field.cols(), field.rows());
  for (const auto& [key, value] : {std::pair{"cell_x", to.cell_x},
                                   {"cell_y", to.cell_y},
                                   {"scale", to.scale},
                                   {"offset", to.offset},
                                   {"exaggeration", to.exaggeration}}) {
    text += fmt::format("{} {:a}\n", key, value);
  }
  if (to.nodata) text += fmt::format("nodata {:a}\n", *to.nodata);
  text +=
      fmt::format("surface {}\nwrap {}\nsolid {}\n", name_of(to.surface), name_of(to.wrap), to.solid ? "yes" : "no");
  if (const auto& dem = dump.generator) {
    return text + fmt::format("generate {} {} {:a} {:a}\n", scarp::name_of(dem->kind), dem->seed, dem->cell_m,
                              dem->feature_size);
  }
  field.visit([&](const auto& grid) {
    for (int row = 0; row < grid.rows; ++row) {
      text += "row";
      for (int col = 0; col < grid.cols; ++col) {
        const auto sample = grid.at(col, row);
        if constexpr (std::is_floating_point_v<std::remove_const_t<decltype(sample)>>) {
          text += fmt::format(" {:a}", sample);
        } else {
          text += fmt::format(" {}", sample);
        }
      }
      text += '\n';
    }
  });
  return text;
}

std::string text_of(const Ray& ray, const std::string& expected, const std::string& answered) {
  std::string text =
      fmt::format("\nray\norigin {:a} {:a} {:a}\ndirection {:a} {:a} {:a}\nrange {:a} {:a}\n", ray.origin.x,
                  ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.t_min, ray.t_max);
  text += ray.start == RayStart::free ? "start free\n"
                                      : fmt::format("start on_surface {} {}\n", ray.start_cell.col, ray.start_cell.row);
  if (!expected.empty()) text += "expected " + expected + "\n";
  if (!answered.empty()) text += "answered " + answered + "\n";
  return text;
}

// Whether two fields are copies of each other.
bool same_field(const HeightField& a, const HeightField& b) {
  return a.visit([](const auto& grid) { return static_cast<const void*>(grid.data); }) ==
         b.visit([](const auto& grid) { return static_cast<const void*>(grid.data); });
}

class DumpReader {
 public:
  explicit DumpReader(const std::string& path) : path_(path) {
    refuse_special_file(path, fmt::format("'{}': ", path));
    in_.open(path);
    if (!in_) throw Error(fmt::format("'{}': cannot be opened", path));
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
      throw Error(fmt::format("'{}': is a directory; a file is needed", path));
    }
  }

  std::vector<RayDump> read() {
    if (!next() || line_ != kHead) fail(fmt::format("the first line must be '{}'", kHead));
    while (next()) {
      const std::string_view key = word();
      if (key == "field") {
        end_ray();
        begin_field();
      } else if (key == "ray") {
        end_ray();
        end_field();
        in_ray_ = true;
        ray_ = {};
        expected_.clear(), answered_.clear();
      } else if (in_ray_) {
        read_ray(key);
      } else if (in_field_) {
        read_field(key);
      } else {
        fail(fmt::format("'{}': a line 'field TYPE COLUMNS ROWS' must come first", key));
      }
      if (!rest_.empty()) fail(fmt::format("'{}' is too much", rest_));
    }
    end_ray();
    if (dumps_.empty()) fail("there is no ray in it");
    return std::move(dumps_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(fmt::format("'{}', line {}: {}", path_, std::max(1, number_), what));
  }

  // Moves to the next line with content; returns false at the end.
  bool next() {
    while (std::getline(in_, line_)) {
      ++number_;
      if (!line_.empty() && line_.back() == '\r') line_.pop_back();
      rest_ = line_;
      skip_blanks();
      if (!rest_.empty() && rest_.front() != '#') return true;
    }
    return false;
  }
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }
  std::string_view word() {
    const std::string_view found = rest_.substr(0, rest_.find_first_of(" \t"));
    rest_.remove_prefix(found.size());
    skip_blanks();
    return found;
  }

  double number(std::string_view what) {
    const std::string_view text = word();
    std::string_view digits = text;
    const bool negative = digits.starts_with('-');
    digits.remove_prefix(negative);
    const bool hex = digits.starts_with("0x");
    if (hex) digits.remove_prefix(2);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value,
                                              hex ? std::chars_format::hex : std::chars_format::general);
    if (error != std::errc() || end != digits.data() + digits.size() || digits.starts_with('-')) {
      fail(fmt::format("{} '{}' is no number", what, text));
    }
    return negative ? -value : value;
  }
  template <class Integer>
  Integer whole(std::string_view what) {
    const std::string_view text = word();
    Integer value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail(fmt::format("{} '{}' is no whole number in range", what, text));
    }
    return value;
  }
  // The index of one of several names.
  std::size_t choice(std::string_view what, std::initializer_list<std::string_view> names) {
    const std::string_view text = word();
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) fail(fmt::format("{} '{}': unknown (available: {})", what, text, fmt::join(names, ", ")));
    return static_cast<std::size_t>(found - names.begin());
  }

  void begin_field() {
    in_ray_ = false;
    in_field_ = true;
    field_.reset();
    generator_.reset();
    settings_ = {};
    samples_.clear();
    type_ = static_cast<SampleType>(choice("type", {"int16", "uint16", "float32"}));
    cols_ = whole<int>("columns");
    rows_ = whole<int>("rows");
    if (cols_ < 1 || rows_ < 1) fail(fmt::format("{} x {} samples; at least 1 x 1 are needed", cols_, rows_));
  }

  void read_field(std::string_view key) {
    if (key == "cell_x") {
      settings_.cell_x = number(key);
    } else if (key == "cell_y") {
      settings_.cell_y = number(key);
    } else if (key == "scale") {
      settings_.scale = number(key);
    } else if (key == "offset") {
      settings_.offset = number(key);
    } else if (key == "exaggeration") {
      settings_.exaggeration = number(key);
    } else if (key == "nodata") {
      settings_.nodata = number(key);
    } else if (key == "surface") {
      settings_.surface = choice(key, {"bilinear", "triangles"}) == 0 ? Surface::bilinear : Surface::triangles;
    } else if (key == "wrap") {
      settings_.wrap = static_cast<Wrap>(choice(key, {"none", "periodic", "shared_border"}));
    } else if (key == "solid") {
      settings_.solid = choice(key, {"no", "yes"}) == 1;
    } else if (key == "row") {
      read_row();
    } else if (key == "generate") {
      read_generator();
    } else {
      fail(fmt::format("'{}' is no line of a field", key));
    }
  }

  void read_row() {
    if (generator_) fail("the samples are generated; there can be no rows");
    if (samples_.size() == static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_)) {
      fail(fmt::format("more than {} rows", rows_));
    }
    const std::size_t before = samples_.size();
    while (!rest_.empty()) samples_.push_back(number("sample"));
    if (samples_.size() - before != static_cast<std::size_t>(cols_)) {
      fail(fmt::format("{} samples; the field has {} columns", samples_.size() - before, cols_));
    }
  }

  void read_generator() {
    if (generator_ || !samples_.empty()) fail("the samples are already there");
    if (type_ != SampleType::float32) fail("generated samples are float32");
    if (std::int64_t{cols_} * rows_ > kMostGenerated) {
      fail(fmt::format("{} x {} samples; dumps generate {} at most", cols_, rows_, kMostGenerated));
    }
    ProceduralDem dem{.cols = cols_, .rows = rows_};
    dem.kind = choice("kind", {"fbm", "ridged"}) == 0 ? TerrainKind::fbm : TerrainKind::ridged;
    dem.seed = whole<std::uint64_t>("seed");
    dem.cell_m = number("cell");
    dem.feature_size = number("feature size");
    with_line([&] { validate(dem); });
    generator_ = dem;
  }

  void read_ray(std::string_view key) {
    if (key == "origin" || key == "direction") {
      dvec3& to = key == "origin" ? ray_.origin : ray_.direction;
      for (int axis = 0; axis < 3; ++axis) to[axis] = number(key);
    } else if (key == "range") {
      ray_.t_min = number("t_min");
      ray_.t_max = number("t_max");
    } else if (key == "start") {
      ray_.start = choice(key, {"free", "on_surface"}) == 0 ? RayStart::free : RayStart::on_surface;
      if (ray_.start == RayStart::on_surface) ray_.start_cell = {whole<int>("column"), whole<int>("row")};
    } else if (key == "expected" || key == "answered") {
      (key == "expected" ? expected_ : answered_) = rest_;
      rest_ = {};
    } else {
      fail(fmt::format("'{}' is no line of a ray", key));
    }
  }

  // The field is complete: it is built once, for all of its rays.
  void end_field() {
    if (!in_field_) fail("a ray without a field; a line 'field TYPE COLUMNS ROWS' must come first");
    if (field_) return;
    const std::size_t count = static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_);
    if (!generator_ && samples_.size() != count) {
      fail(fmt::format("{} of {} rows of samples before the ray", samples_.size() / static_cast<std::size_t>(cols_),
                       rows_));
    }
    with_line([&] {
      switch (type_) {
        case SampleType::int16:
          field_ = HeightField::own(samples_as<std::int16_t>(), cols_, rows_, settings_);
          break;
        case SampleType::uint16:
          field_ = HeightField::own(samples_as<std::uint16_t>(), cols_, rows_, settings_);
          break;
        case SampleType::float32:
          field_ =
              HeightField::own(generator_ ? generate_dem(*generator_) : samples_as<float>(), cols_, rows_, settings_);
      }
    });
  }

  void end_ray() {
    if (!in_ray_) return;
    in_ray_ = false;
    with_line([&] { validate(ray_, *field_); });
    dumps_.push_back({*field_, generator_, ray_, expected_, answered_});
  }

  template <class T>
  std::vector<T> samples_as() const {
    std::vector<T> samples;
    samples.reserve(samples_.size());
    for (const double value : samples_) {
      // NaN is a hole in float32.
      const bool fits = std::is_floating_point_v<T>
                            ? std::isnan(value) || static_cast<double>(static_cast<float>(value)) == value
                            : value >= std::numeric_limits<T>::lowest() && value <= std::numeric_limits<T>::max() &&
                                  value == std::floor(value);
      if (!fits) fail(fmt::format("the sample {} is no {}", value, scarp::name_of(type_)));
      samples.push_back(static_cast<T>(value));
    }
    return samples;
  }

  // Errors that the library throws refer to this line or earlier ones.
  template <class Check>
  void with_line(const Check& check) const {
    try {
      check();
    } catch (const Error& error) {
      const std::string where = fmt::format("'{}', line ", path_);
      if (std::string_view(error.what()).starts_with(where)) throw;
      fail(error.what());
    }
  }

  const std::string& path_;
  std::ifstream in_;
  std::string line_;
  std::string_view rest_;  // the unread rest of the line
  int number_ = 0;

  bool in_field_ = false, in_ray_ = false;
  SampleType type_ = SampleType::float32;
  int cols_ = 0, rows_ = 0;
  HeightFieldSettings settings_;
  std::vector<double> samples_;
  std::optional<ProceduralDem> generator_;
  std::optional<HeightField> field_;
  Ray ray_;
  std::string expected_, answered_;
  std::vector<RayDump> dumps_;
};

}  // namespace

void write_ray_dumps(const std::string& path, std::span<const RayDump> dumps) {
  ReplaceFile file(path);
  std::ofstream out(file.temporary_path());
  out << kHead << '\n';
  for (std::size_t i = 0; i < dumps.size(); ++i) {
    if (i == 0 || !same_field(dumps[i - 1].field, dumps[i].field)) out << text_of(dumps[i]);
    out << text_of(dumps[i].ray, dumps[i].expected, dumps[i].answered);
  }
  out.close();
  if (!out) throw Error(fmt::format("'{}': cannot be written; is the disk full?", path));
  file.commit();
}

std::vector<RayDump> read_ray_dumps(const std::string& path) { return DumpReader(path).read(); }

}  // namespace scarp
