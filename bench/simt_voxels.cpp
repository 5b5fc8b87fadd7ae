// SPDX-License-Identifier: MIT
// `scarp-bench simt --voxels`: the shaders of voxel marches without a card. Pictures of the objects of voxel_sets.h, in
// tiles of 8 x 8 pixels, each a bundle.
#include <fmt/format.h>

#include <array>
#include <mutex>
#include <vector>

#include "bench/report.h"
#include "bench/simt_blocks.h"
#include "bench/simt_options.h"
#include "bench/simt_voxel_trace.h"
#include "bench/voxel_sets.h"
#include "scarp/base/error.h"
#include "scarp/base/parallel.h"
#include "scarp/march/voxel/voxel_table.h"
#include "scarp/scene/scene.h"

namespace scarp::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kGroupRays = 64;
constexpr std::array<std::size_t, 2> kBundleSizes = {32, kGroupRays};
constexpr const char* kReference = "voxel-planes";

struct Paid {
  std::array<SimtBundle, kBundleSizes.size()> bundles{};
  std::uint64_t wrong = 0, hits = 0;
};

// Counts the costs of the bundles of all rays, and rays whose answer differs from the CPU's.
Paid paid_for(const SimtVoxels& voxels, const Scene& scene, const std::vector<Ray>& rays) {
  Paid sum;
  std::mutex adding;
  parallel_for(static_cast<std::int64_t>(rays.size() / kGroupRays), 1, [&](std::int64_t first, std::int64_t last) {
    Paid part;
    std::vector<SimtTrace> traces(kGroupRays);
    for (auto tile = static_cast<std::size_t>(first); tile < static_cast<std::size_t>(last); ++tile) {
      for (std::size_t k = 0; k < kGroupRays; ++k) {
        const Ray& ray = rays[tile * kGroupRays + k];
        traces[k].clear();
        const Hit hit = voxels.trace(ray, &traces[k]), expected = scene.closest_hit(ray);
        part.hits += static_cast<bool>(hit);
        part.wrong += static_cast<bool>(hit) != static_cast<bool>(expected) ||
                      (hit && (hit.t != expected.t || hit.voxel != expected.voxel || hit.part != expected.part));
      }
      for (std::size_t b = 0; b < kBundleSizes.size(); ++b) {
        for (std::size_t k = 0; k < kGroupRays; k += kBundleSizes[b])
          part.bundles[b] += replay(std::span(traces).subspan(k, kBundleSizes[b]));
      }
    }
    const std::scoped_lock lock(adding);
    for (std::size_t b = 0; b < kBundleSizes.size(); ++b) sum.bundles[b] += part.bundles[b];
    sum.wrong += part.wrong;
    sum.hits += part.hits;
  });
  return sum;
}

}  // namespace

void run_simt_voxels(const SimtOptions& options, SimtShaders shaders, const ReportOptions& report) {
  Json rows = Json::array();
  std::vector<std::vector<std::string>> lines{{"set", "objects", "march", "bundle", "nodes", "asked", "turns", "instr.",
                                               "memory", "lines", "planes: instr.", "memory", "lines"}};
  for (const std::string& set : options.voxel_sets) {
    for (const int layers : options.voxel_layers) {
      const std::vector<VoxelPlace> places = object_places(layers);
      const std::vector<Ray> rays = camera_rays(options.voxel_stride);
      std::array<SimtSum, kBundleSizes.size()> planes{};
      std::array<SimtBundle, kBundleSizes.size()> planes_bundles{};
      for (const VoxelMarchEntry& march : voxel_marches()) {
        if (!march.gpu) continue;
        const auto model = std::make_shared<const VoxelModel>(voxel_object(set), march, std::vector<VoxelColour>{},
                                                              VoxelModel::Extent::bounds);
        const PlacedVoxels placed{{model}, places};
        const Paid paid = paid_for(SimtVoxels(placed), Scene(scene_voxels(placed)), rays);
        if (paid.wrong != 0) throw Error(fmt::format("simt: {} rays have other answers than the CPU's", paid.wrong));
        const SimtShader& shader = shaders.find(march.name);
        for (std::size_t b = 0; b < kBundleSizes.size(); ++b) {
          const SimtBundle& bundle = paid.bundles[b];
          const SimtSum sum = cost_of(bundle, shader);
          if (march.name == kReference) planes[b] = sum, planes_bundles[b] = bundle;
          const auto bundles = static_cast<double>(bundle.of(SimtBlock::begin));
          const auto per_bundle = [&](std::uint64_t total) { return static_cast<double>(total) / bundles; };
          const auto ratio = [](std::uint64_t a, std::uint64_t of) {
            return of == 0 ? Json() : Json(static_cast<double>(a) / static_cast<double>(of));
          };
          Json row{{"set", set}, {"objects", places.size()}, {"march", march.name}, {"bundle", kBundleSizes[b]}};
          row["hit_share"] = static_cast<double>(paid.hits) / static_cast<double>(rays.size());
          row["nodes"] = per_bundle(bundle.of(SimtBlock::frame));
          row["objects_asked"] = per_bundle(bundle.of(SimtBlock::object));
          row["turns"] = per_bundle(bundle.of(SimtBlock::walk));
          row["turns_per_ray"] = static_cast<double>(bundle.lanes[static_cast<std::size_t>(SimtBlock::walk)]) /
                                 static_cast<double>(rays.size());
          for (std::size_t block = 0; block < kSimtBlocks; ++block) {
            if (bundle.runs[block] > 0)
              row[fmt::format("{}_instructions", kSimtBlockNames[block])] =
                  per_bundle(bundle.runs[block]) * shader.costs[block].instructions;
          }
          row["instructions"] = per_bundle(sum.instructions);
          row["memory_instructions"] = per_bundle(sum.memory);
          for (std::size_t k = 0; k < kCacheLines.size(); ++k)
            row[fmt::format("lines_{}", kCacheLines[k])] = per_bundle(bundle.lines[k]);
          row["of_planes_instructions"] = ratio(sum.instructions, planes[b].instructions);
          row["of_planes_memory"] = ratio(sum.memory, planes[b].memory);
          row["of_planes_lines_128"] = ratio(bundle.lines[0], planes_bundles[b].lines[0]);
          row["compilers"] = shaders.compilers;
          lines.push_back(
              {set, fmt::format("{}", places.size()), std::string(march.name), fmt::format("{}", kBundleSizes[b])});
          for (const char* number : {"nodes", "objects_asked", "turns", "instructions", "memory_instructions",
                                     "lines_128", "of_planes_instructions", "of_planes_memory", "of_planes_lines_128"})
            lines.back().push_back(row[number].is_null() ? "-" : short_number(row[number]));
          rows.push_back(std::move(row));
        }
      }
    }
  }
  print_table(lines, 3);
  write_json(report, rows);
}

}  // namespace scarp::bench
