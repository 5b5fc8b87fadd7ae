// SPDX-License-Identifier: MIT
#include "scarp/source/table/ray_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

#include "scarp/base/error.h"
#include "scarp/source/npy_header.h"
#include "scarp/source/table/column_names.h"
#include "scarp/source/table/csv_rows.h"
#include "scarp/source/table/table_file.h"

namespace scarp {
namespace {

std::string_view needed(RayRows are) {
  return are == RayRows::rays ? "required: x,y,z and either dx,dy,dz or tx,ty,tz; or lon,lat,z and either dx,dy,dz or "
                                "tlon,tlat,tz"
                              : "required: x,y[,z] and either dx,dy,dz or tx,ty[,tz]; or lon,lat[,z] and "
                                "either dx,dy,dz or tlon,tlat[,tz]";
}

enum Column : std::size_t { x, y, z, dx, dy, dz, tx, ty, tz, t_min, t_max, start_col, start_row, column_count };
constexpr std::array<std::string_view, column_count> kNames = {
    "x", "y", "z", "dx", "dy", "dz", "tx", "ty", "tz", "t_min", "t_max", "start_col", "start_row"};
constexpr auto kNamesInDegrees = [] {
  auto names = kNames;
  names[x] = "lon", names[y] = "lat", names[tx] = "tlon", names[ty] = "tlat";
  return names;
}();

std::string place_of(RayRows are, std::int64_t line, std::size_t row) {
  const std::string_view one = are == RayRows::rays ? "ray" : "camera";
  return line > 0 ? fmt::format("line {} ({} {})", line, one, row) : fmt::format("{} {}", one, row);
}

// Checks a row from any source; calls `place` only for errors.
template <class Place>
void check(const RayRow& row, RayAim aim, const Place& place) {
  const auto finite = [](const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  const auto refuse = [&](std::string_view what) { throw Error(fmt::format("{}: {}", place(), what)); };
  if (!finite(row.origin)) refuse("origin is not finite");
  if (aim == RayAim::direction) {
    if (!finite(row.aim)) refuse("direction is not finite");
    if (row.aim == dvec3(0.0)) refuse("direction is zero");
  } else {
    if (!finite(row.aim)) refuse("target is not finite");
    if (row.aim == row.origin) refuse("target equals the origin");
  }
  if (!std::isfinite(row.t_min) || std::isnan(row.t_max) || row.t_max < row.t_min) {
    refuse(fmt::format("range is {} to {} (t_min must be finite and at most t_max)", row.t_min, row.t_max));
  }
}

// Maps the fields of a row to columns.
class CsvHeader {
 public:
  CsvHeader(std::span<const std::string_view> fields, RayRows are) : fields_(fields.size()), are_(are) {
    places_.fill(kNone);
    const std::vector<std::string> given = column_names(fields);
    const auto is_given = [&](std::string_view name) {
      return std::find(given.begin(), given.end(), name) != given.end();
    };
    lonlat_ = is_given("lon") && (are == RayRows::cameras || !(is_given("x") && is_given("y")));
    const auto& names = this->names();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const std::string& name = given[i];
      const auto known = std::find(names.begin(), names.end(), name);
      if (known == names.end()) {
        carried_.push_back(i);
        continue;
      }
      std::size_t& place = places_[static_cast<std::size_t>(known - names.begin())];
      if (place != kNone) throw Error(fmt::format("duplicate column '{}'", name));
      place = i;
    }
    const bool directions = has(dx) || has(dy) || has(dz), targets = has(tx) || has(ty) || has(tz);
    if (directions && targets) throw Error("header has both directions and targets (use dx,dy,dz or tx,ty,tz)");
    require({x, y});
    if (targets) {
      require({tx, ty});
    } else {
      require({dx, dy, dz});
    }
    if (are == RayRows::rays) require({z});
    if (are == RayRows::rays && targets) require({tz});
    if (has(start_col) != has(start_row)) {
      throw Error(fmt::format("no column '{}', required with '{}'", kNames[has(start_col) ? start_row : start_col],
                              kNames[has(start_col) ? start_col : start_row]));
    }
    aim_ = targets ? RayAim::target : RayAim::direction;
  }

  RayRows are() const { return are_; }
  RayAim aim() const { return aim_; }
  bool lonlat() const { return lonlat_; }
  const std::array<std::string_view, column_count>& names() const { return lonlat_ ? kNamesInDegrees : kNames; }
  bool has(Column column) const { return places_[column] != kNone; }
  std::size_t operator[](Column column) const { return places_[column]; }
  std::size_t fields() const { return fields_; }
  const std::vector<std::size_t>& carried() const { return carried_; }

 private:
  static constexpr std::size_t kNone = std::string_view::npos;

  void require(std::initializer_list<Column> columns) const {
    for (const Column column : columns) {
      if (!has(column)) throw Error(fmt::format("no column '{}' ({})", names()[column], needed(are_)));
    }
  }

  std::array<std::size_t, column_count> places_{};
  std::vector<std::size_t> carried_;
  std::size_t fields_;
  RayRows are_;
  RayAim aim_ = RayAim::direction;
  bool lonlat_ = false;
};

// Sets the indices before the first ray is left out.
void set_indices(RayTable& table) {
  table.indices.resize(table.rows.size());
  std::iota(table.indices.begin(), table.indices.end(), 0);
}

// Returns a table with this header and without rows.
RayTable table_of(const CsvHeader& header) {
  RayTable table;
  table.are = header.are();
  table.aim = header.aim();
  table.lonlat = header.lonlat();
  table.has_z = header.has(z);
  table.has_target_z = header.has(tz);
  return table;
}

// The fields of one row as numbers.
class CsvRow {
 public:
  CsvRow(const CsvHeader& header, const CsvRows& rows, std::size_t number)
      : header_(header), rows_(rows), number_(number) {
    if (rows.fields().size() != header.fields()) {
      refuse(fmt::format("{} fields instead of {}", rows.fields().size(), header.fields()));
    }
  }

  std::string place() const { return place_of(header_.are(), rows_.line(), number_); }
  double number(Column column) const {
    double value = 0;
    if (text(column).empty()) refuse(fmt::format("column '{}' is empty (expected a number)", header_.names()[column]));
    if (!parse_field(text(column), value)) {
      refuse(fmt::format("'{}' in column '{}' is not a number", shown_field(text(column)), header_.names()[column]));
    }
    return value;
  }
  double number(Column column, double otherwise) const { return given(column) ? number(column) : otherwise; }
  dvec3 vector(Column first, Column second, Column third) const {
    return {number(first), number(second), header_.has(third) ? number(third) : 0};
  }
  int whole(Column column) const {
    int value = 0;
    if (!parse_field(text(column), value)) {
      refuse(fmt::format("'{}' in column '{}' is not an integer", shown_field(text(column)), header_.names()[column]));
    }
    return value;
  }
  bool given(Column column) const { return header_.has(column) && !text(column).empty(); }

  RayRow ray() const {
    const bool targets = header_.aim() == RayAim::target;
    RayRow row;
    row.line = rows_.line();
    row.origin = vector(x, y, z);
    row.aim = targets ? vector(tx, ty, tz) : vector(dx, dy, dz);
    row.t_min = number(t_min, row.t_min);
    row.t_max = number(t_max, targets ? 1.0 : row.t_max);
    if (given(start_col) || given(start_row)) {
      row.start = RayStart::on_surface;
      row.start_cell = {whole(start_col), whole(start_row)};
    }
    check(row, header_.aim(), [&] { return place(); });
    return row;
  }

 private:
  std::string_view text(Column column) const { return trimmed(rows_.fields()[header_[column]]); }
  [[noreturn]] void refuse(const std::string& what) const { throw Error(fmt::format("{}: {}", place(), what)); }

  const CsvHeader& header_;
  const CsvRows& rows_;
  std::size_t number_;
};

// Reads one number of an array from these bytes.
template <class Number, class Bits>
double number_at(const char* bytes, bool big_endian) {
  Bits bits = 0;
  for (std::size_t k = 0; k < sizeof(Bits); ++k) {
    const auto byte = static_cast<unsigned char>(bytes[k]);
    bits = static_cast<Bits>(bits | Bits{byte} << (8 * (big_endian ? sizeof(Bits) - 1 - k : k)));
  }
  return static_cast<double>(std::bit_cast<Number>(bits));
}

using NumberReader = double (*)(const char* bytes, bool big_endian);

// Returns null for types that are not numbers.
NumberReader reader_of(char kind, int bytes) {
  switch (kind) {
    case 'f':
      if (bytes == 4) return number_at<float, std::uint32_t>;
      if (bytes == 8) return number_at<double, std::uint64_t>;
      break;
    case 'i':
      if (bytes == 1) return number_at<std::int8_t, std::uint8_t>;
      if (bytes == 2) return number_at<std::int16_t, std::uint16_t>;
      if (bytes == 4) return number_at<std::int32_t, std::uint32_t>;
      if (bytes == 8) return number_at<std::int64_t, std::uint64_t>;
      break;
    case 'u':
      if (bytes == 1) return number_at<std::uint8_t, std::uint8_t>;
      if (bytes == 2) return number_at<std::uint16_t, std::uint16_t>;
      if (bytes == 4) return number_at<std::uint32_t, std::uint32_t>;
      if (bytes == 8) return number_at<std::uint64_t, std::uint64_t>;
      break;
    default:
      break;
  }
  return nullptr;
}

// Returns the number of rays after a header, at `bytes` per ray.
std::size_t rays_of(const NpyHeader& header, std::string_view behind, std::int64_t bytes) {
  // In double: the product cannot overflow.
  const double needed = static_cast<double>(header.shape[0]) * static_cast<double>(bytes);
  if (static_cast<double>(behind.size()) < needed) {
    throw Error(fmt::format("truncated: {} rays need {:.0f} bytes after the header, but the file has {}",
                            header.shape[0], needed, behind.size()));
  }
  return static_cast<std::size_t>(header.shape[0]);
}

// Adds the next ray of the file, which `read` returns or refuses.
template <class Read>
void add_ray(RayTable& table, BadRays bad, const Read& read) {
  const auto index = static_cast<std::int64_t>(table.rows.size() + table.bad.size());
  try {
    table.rows.push_back(read());
    if (!table.bad.empty()) table.indices.push_back(index);
  } catch (const Error& error) {
    if (bad == BadRays::refused) throw;
    if (table.bad.empty()) set_indices(table);
    table.bad.push_back({index, error.what()});
  }
}

RayTable parse_structures(const NpyHeader& header, const char* data, std::size_t rays, RayRows are, BadRays bad) {
  std::vector<std::string_view> names;
  for (const NpyField& field : header.fields) names.push_back(field.name);
  const CsvHeader columns(names, are);
  std::array<NumberReader, column_count> readers{};
  for (std::size_t c = 0; c < column_count; ++c) {
    if (!columns.has(static_cast<Column>(c))) continue;
    const NpyField& field = header.fields[columns[static_cast<Column>(c)]];
    readers[c] = reader_of(field.kind, field.bytes);
    if (!readers[c])
      throw Error(fmt::format("field '{}' is not a number of type i1 to i8, u1 to u8, f4 or f8", field.name));
  }
  RayTable table = table_of(columns);
  const bool targets = table.aim == RayAim::target;
  table.rows.reserve(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const char* const structure = data + i * static_cast<std::size_t>(header.bytes);
    const auto number = [&](Column column) {
      if (!columns.has(column)) return 0.0;
      const NpyField& field = header.fields[columns[column]];
      return readers[column](structure + field.begin, field.big_endian);
    };
    const auto whole = [&](Column column) {
      const double value = number(column);
      if (value != std::floor(value) || !(std::abs(value) <= std::numeric_limits<int>::max())) {
        throw Error(fmt::format("{}: {} in field '{}' is not an integer", place_of(are, 0, i), value, kNames[column]));
      }
      return static_cast<int>(value);
    };
    add_ray(table, bad, [&] {
      RayRow row;
      row.origin = {number(x), number(y), number(z)};
      row.aim = targets ? dvec3(number(tx), number(ty), number(tz)) : dvec3(number(dx), number(dy), number(dz));
      if (columns.has(t_min)) row.t_min = number(t_min);
      if (columns.has(t_max) || targets) row.t_max = columns.has(t_max) ? number(t_max) : 1.0;
      if (columns.has(start_col)) {
        row.start = RayStart::on_surface;
        row.start_cell = {whole(start_col), whole(start_row)};
      }
      check(row, table.aim, [&] { return place_of(are, 0, i); });
      return row;
    });
  }
  return table;
}

RayTable parse_plain(const NpyHeader& header, const char* data, std::size_t rays, RayRows are, BadRays bad) {
  const NumberReader reader = reader_of(header.kind, header.bytes);
  const auto columns = static_cast<std::size_t>(header.shape[1]), bytes = static_cast<std::size_t>(header.bytes);
  RayTable table;
  table.are = are;
  table.rows.reserve(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    const auto number = [&](std::size_t column) {
      const std::size_t at = header.fortran_order ? column * rays + i : i * columns + column;
      return reader(data + at * bytes, header.big_endian);
    };
    add_ray(table, bad, [&] {
      RayRow row;
      row.origin = {number(0), number(1), number(2)};
      row.aim = {number(3), number(4), number(5)};
      if (columns == 8) {
        row.t_min = number(6);
        row.t_max = number(7);
      }
      check(row, table.aim, [&] { return place_of(are, 0, i); });
      return row;
    });
  }
  return table;
}

}  // namespace

void RayTable::leave_out(std::span<const BadRay> rays) {
  if (rays.empty()) return;
  if (bad.empty()) set_indices(*this);
  std::size_t kept = 0, next = 0;  // of `rows` and `rays`
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (next < rays.size() && indices[i] == rays[next].ray) {
      ++next;
      continue;
    }
    rows[kept] = rows[i], indices[kept] = indices[i];
    ++kept;
  }
  rows.resize(kept), indices.resize(kept);
  const auto before = static_cast<std::ptrdiff_t>(bad.size());
  bad.insert(bad.end(), rays.begin(), rays.end());
  std::inplace_merge(bad.begin(), bad.begin() + before, bad.end(),
                     [](const BadRay& a, const BadRay& b) { return a.ray < b.ray; });
}

std::string RayTable::where(std::size_t row) const {
  return fmt::format("{}: {}", path, place_of(are, rows[row].line, static_cast<std::size_t>(index(row))));
}

RayTable parse_ray_csv(std::string_view bytes, RayRows are, BadRays bad) {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) throw Error("UTF-16 text (save it as UTF-8)");
  CsvRows rows(bytes);
  if (!rows.next()) throw Error(fmt::format("empty file, no header ({})", needed(are)));
  if (double number = 0; parse_field(trimmed(rows.fields().front()), number)) {
    throw Error(fmt::format("first line contains numbers instead of a header ({})", needed(are)));
  }
  const CsvHeader header(rows.fields(), are);
  RayTable table = table_of(header);
  for (const std::size_t i : header.carried()) table.carried.names.emplace_back(trimmed(rows.fields()[i]));
  while (rows.next()) {
    add_ray(table, bad, [&] { return CsvRow(header, rows, table.rows.size() + table.bad.size()).ray(); });
    for (const std::size_t i : header.carried())
      table.carried.cells.emplace_back(i < rows.fields().size() ? rows.fields()[i] : std::string_view());
  }
  return table;
}

RayTable parse_ray_npy(std::string_view bytes, RayRows are, BadRays bad) {
  const NpyHeader header = parse_npy_table_header(bytes);
  const auto& shape = header.shape;
  const std::string_view behind = bytes.substr(static_cast<std::size_t>(header.data_begin));
  if (!header.fields.empty()) {
    if (shape.size() != 1) {
      throw Error(fmt::format("array of structures of shape ({}) (one dimension required)", fmt::join(shape, ", ")));
    }
    return parse_structures(header, behind.data(), rays_of(header, behind, header.bytes), are, bad);
  }
  if (header.kind != 'f' || (header.bytes != 4 && header.bytes != 8)) {
    throw Error(fmt::format("unsupported type '{}' (supported: float32, float64)", header.descr));
  }
  if (shape.size() != 2 || (shape[1] != 6 && shape[1] != 8)) {
    throw Error(fmt::format("array of shape ({}) (must be (N, 6) or (N, 8): x,y,z,dx,dy,dz[,t_min,t_max])",
                            fmt::join(shape, ", ")));
  }
  return parse_plain(header, behind.data(), rays_of(header, behind, shape[1] * header.bytes), are, bad);
}

RayTable read_rays(const std::string& path, RayRows are, BadRays bad) {
  try {
    const std::string bytes = table_bytes(path);
    const bool npy = bytes.starts_with("\x93NUMPY") || (path.ends_with(".npy") && !bytes.empty());
    RayTable table = npy ? parse_ray_npy(bytes, are, bad) : parse_ray_csv(bytes, are, bad);
    table.path = path;
    for (BadRay& ray : table.bad) ray.why = fmt::format("{}: {}", path, ray.why);
    return table;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace scarp
