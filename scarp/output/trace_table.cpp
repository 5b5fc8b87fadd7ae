// SPDX-License-Identifier: MIT
#include "scarp/output/trace_table.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <iterator>
#include <string_view>

#include "scarp/base/error.h"
#include "scarp/base/file_name.h"
#include "scarp/output/hit_table.h"
#include "scarp/output/output_file.h"

namespace scarp {
namespace {

constexpr std::string_view kTraceColumns =
    "ray,index,kind,t,t_out,x,y,z,clearance,free,level,col,row,maximum,object,voxel_x,voxel_y,voxel_z,low_x,low_y,"
    "low_z,size\n";
// Empty columns: those of a sample, of a block or cell, and of a voxel.
constexpr std::string_view kNoSample = ",,", kNoBlock = ",,,,", kNoVoxel = ",,,,,,,,";

// A column with a number; empty if it is none.
std::string column(double number) { return std::isfinite(number) ? fmt::format(",{}", number) : ","; }

std::string step_columns(const TraceStep& step) {
  std::string text;
  const auto out = std::back_inserter(text);
  if (is_sample(step.kind)) {
    text += column(step.clearance);
    text += step.free != 0 ? column(step.free) : ",";
  } else {
    text += kNoSample;
  }
  if (is_block(step.kind) || is_cell(step.kind)) {
    fmt::format_to(out, ",{},{},{}", step.level, step.col, step.row);
    text += is_block(step.kind) ? column(step.maximum) : ",";
  } else {
    text += kNoBlock;
  }
  if (is_voxel(step.kind)) {
    const ivec3 &v = step.voxel, &low = step.low;
    fmt::format_to(out, ",{},{},{},{},{},{},{},{}", step.object, v.x, v.y, v.z, low.x, low.y, low.z, step.size);
  } else {
    text += kNoVoxel;
  }
  return text;
}

}  // namespace

TraceTable::TraceTable(const std::string& path) {
  if (extension_of(path) != ".csv") throw Error(fmt::format("{}: samples are CSV (end the name in .csv)", path));
  file_ = std::make_unique<OutputFile>(path);
  file_->add(kTraceColumns);
}

TraceTable::~TraceTable() = default;

void TraceTable::add(std::int64_t ray, std::span<const TraceStep> steps, std::span<const dvec3> positions,
                     const Hit& hit) {
  const auto place = [](const dvec3& p) { return column(p.x) + column(p.y) + column(p.z); };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const TraceStep& step = steps[i];
    file_->add(fmt::format("{},{},{}{}{}{}{}\n", ray, i, name_of(step.kind), column(step.t), column(step.t_out),
                           place(positions[i]), step_columns(step)));
  }
  std::string text = fmt::format("{},{},{}", ray, steps.size(), name_of(hit.status));
  text += hit ? column(hit.t) + column(hit.t) + place(positions.back()) : ",,,,,";
  file_->add(fmt::format("{}{}{}{}\n", text, kNoSample, kNoBlock, kNoVoxel));
}

void TraceTable::commit() { file_->commit(); }

}  // namespace scarp
