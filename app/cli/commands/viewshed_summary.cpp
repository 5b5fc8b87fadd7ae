// SPDX-License-Identifier: MIT
#include "app/cli/commands/viewshed_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "scarp/base/csv_text.h"
#include "scarp/base/parallel.h"

namespace scarp::cli {

void ViewshedSummary::add(std::size_t observer, const Viewpoint& view, std::span<const Seen> codes, int first_row) {
  const SightGround& ground = view.ground();
  const auto cols = static_cast<std::size_t>(ground.field().cols());
  std::int64_t visible = 0, hidden = 0;
  double farthest = 0;  // squared
  std::mutex mutex;
  constexpr std::int64_t kRowsAtOnce = 16;
  parallel_for(static_cast<std::int64_t>(codes.size() / cols), kRowsAtOnce, [&](std::int64_t begin, std::int64_t end) {
    std::int64_t seen = 0, unseen = 0;
    double far = 0;
    for (std::size_t i = static_cast<std::size_t>(begin) * cols; i < static_cast<std::size_t>(end) * cols; ++i) {
      unseen += codes[i] == Seen::hidden;
      if (codes[i] != Seen::visible) continue;
      ++seen;
      far = std::max(far,
                     ground.square_distance(static_cast<double>(i % cols), first_row + static_cast<double>(i / cols)));
    }
    const std::scoped_lock lock(mutex);
    visible += seen;
    hidden += unseen;
    farthest = std::max(farthest, far);
  });
  Sum& sum = sums_[observer];
  const HeightFieldSettings& cell = ground.field().settings();
  sum.visible += static_cast<double>(visible);
  sum.hidden += static_cast<double>(hidden);
  sum.area = sum.visible * cell.cell_x * cell.cell_y;
  sum.farthest = std::max(sum.farthest, std::sqrt(farthest));
  sum.eye = view.eye();
}

double ViewshedSummary::share(std::size_t observer) const {
  const double all = sums_[observer].visible + sums_[observer].hidden;
  return all > 0 ? sums_[observer].visible / all : 0;
}

std::string summary_csv(const ViewshedSummary& summary, const PlaceTable& table, const RowStatus* status,
                        std::span<const SummaryRow> observers) {
  std::string out;
  for (const std::string& name : table.carried.names) append_csv_text(out, name), out += ',';
  out += fmt::format("observer,{}x,y,eye,area,share,farthest\n", status ? "status," : "");
  std::size_t next = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    for (std::size_t k = 0; k < table.carried.names.size(); ++k)
      append_csv_text(out, table.carried.at(i, k)), out += ',';
    out += fmt::format("{},", i + 1);
    if (status) out += fmt::format("{},", status->of(i));
    if (next == observers.size() || observers[next].row != i) {
      out += ",,,,,\n";
      continue;
    }
    const dvec2 at = observers[next].at;
    out += fmt::format("{:.10g},{:.10g},{:.10g},{:.10g},{:.6g},{:.10g}\n", at.x, at.y, summary.eye(next),
                       summary.area(next), summary.share(next), summary.farthest(next));
    ++next;
  }
  return out;
}

}  // namespace scarp::cli
