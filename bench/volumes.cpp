// SPDX-License-Identifier: MIT
// `scarp-bench volumes`: from a file of numbers to a voxel model, compared with reading the same bytes into memory.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/command.h"
#include "bench/commands.h"
#include "bench/protocol.h"
#include "bench/report.h"
#include "bench/trace_options.h"
#include "scarp/base/error.h"
#include "scarp/scene/file/from_volume.h"

namespace scarp::bench {
namespace {

// `volumes`: from a file of numbers to voxels, compared with reading its bytes.
struct VolumesOptions {
  int side = 1024;  // voxels
  int repeats = 3;
};

using Json = nlohmann::ordered_json;

constexpr double kSolidFrom = 100;

// A temporary file.
class ScratchFile {
 public:
  ScratchFile() : path_(std::filesystem::temp_directory_path() / fmt::format("scarp-bench-{}.raw", getpid())) {}
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

// Waves that fade from the middle outwards, like a scan of one body; a third of the numbers is solid.
template <class T>
void write_waves(const std::string& path, int side) {
  std::ofstream out(path, std::ios::binary);
  std::vector<T> row(static_cast<std::size_t>(side));
  const double scale = sizeof(T) == 1 ? 1 : 257;
  const auto wave = [&](int i, double waves) { return 60 * std::sin(i * waves / side); };
  const auto from_middle = [&](int i) { return static_cast<double>(i) / side - 0.5; };
  for (int z = 0; z < side; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const double away = std::hypot(from_middle(x), from_middle(y), from_middle(z));
        const double value = 128 + wave(x, 13) + wave(y, 17) + wave(z, 11) - 400 * away;
        row[static_cast<std::size_t>(x)] = static_cast<T>(scale * std::clamp(value, 0.0, 255.0));
      }
      out.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size() * sizeof(T)));
    }
  }
  out.close();
  if (!out) throw Error(fmt::format("{}: cannot be written (is the disk full?)", path));
}

void read_plainly(const std::string& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  std::string bytes(static_cast<std::size_t>(in.tellg()), '\0');
  in.seekg(0);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw Error(fmt::format("{}: cannot be read", path));
}

// Reads voxels with the given number of colours.
double seconds_of(const std::string& path, const std::string& format, std::size_t colours, double solid_from) {
  const std::vector<VoxelColour> palette(colours);
  FromVolumeOptions options;
  options.solid_from = solid_from;
  const Stopwatch watch;
  const DenseVolume volume = read_volume(path, format);
  const SolidRange range = colours > 1 ? solid_range(volume, solid_from) : SolidRange{};
  const PlacedVoxels voxels = placed_voxels_from(volume, palette, range, options);
  const double seconds = watch.wall_s();
  if (voxels.models[0]->grid().solid_count() == 0) throw Error("no voxel is solid");
  return seconds;
}

void run_volumes(const VolumesOptions& options, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"voxels", "type", "colours", "build s", "plain read s", "ratio"}};
  const ScratchFile file;
  for (const bool wide : {false, true}) {
    const int side = options.side;
    wide ? write_waves<std::uint16_t>(file.path(), side) : write_waves<std::uint8_t>(file.path(), side);
    const std::string type = wide ? "u16le" : "u8", format = fmt::format("{0}x{0}x{0}:{1}", side, type);
    const double solid_from = kSolidFrom * (wide ? 257 : 1);
    for (const std::size_t colours : {std::size_t{1}, std::size_t{255}}) {
      std::vector<double> build, plain;
      for (int repeat = 0; repeat <= options.repeats; ++repeat) {
        build.push_back(seconds_of(file.path(), format, colours, solid_from));
        const Stopwatch watch;
        read_plainly(file.path());
        plain.push_back(watch.wall_s());
      }
      // The first pass is a warm-up.
      const double build_s = median({build.begin() + 1, build.end()}),
                   plain_s = median({plain.begin() + 1, plain.end()});
      Json row = {{"side", side},
                  {"type", type},
                  {"colours", colours},
                  {"build_s", build_s},
                  {"plain_read_s", plain_s},
                  {"ratio", build_s / plain_s}};
      lines.push_back({fmt::format("{}^3", side), type, short_number(row["colours"]), short_number(row["build_s"]),
                       short_number(row["plain_read_s"]), short_number(row["ratio"])});
      rows.push_back(std::move(row));
    }
  }
  print_table(lines, 2);
  write_json(report, rows);
}

}  // namespace

void add_volumes(cli::Program& program) {
  auto [command, o] =
      add_command<VolumesOptions>(program, "volumes", "How fast files of numbers become voxels", run_volumes);
  command.add(&o.side, {.names = "--side", .help = "voxels per side", .range = {8, 2048}});
  add_repeats_option(command, o.repeats);
}

}  // namespace scarp::bench
