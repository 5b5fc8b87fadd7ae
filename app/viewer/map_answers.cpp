// SPDX-License-Identifier: MIT
#include "app/viewer/map_answers.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "scarp/base/error.h"

namespace scarp::viewer {
namespace {

std::string metres_text(double metres) {
  constexpr double kKilometre = 1000;
  return metres < kKilometre ? fmt::format("{:.1f} m", metres) : fmt::format("{:.2f} km", metres / kKilometre);
}

}  // namespace

GroundAnswers& MapAnswers::answers() {
  if (!answers_) answers_ = std::make_unique<GroundAnswers>(subject_->opening(), subject_->shared());
  return *answers_;
}

void MapAnswers::follow(const Subject& subject) {
  const std::optional<Observer> before = observer_;
  unpin();
  horizon_worker_.cancel();
  horizon_.reset(), horizon_node_.reset();
  answers_.reset();
  subject_ = &subject;
  if (!before) return;
  try {
    set(*before);
  } catch (const Error&) {
    unpin();  // the new input cannot answer
  }
}

void MapAnswers::pin(const dvec3& point) {
  Observer observer = observer_.value_or(Observer{});
  observer.node = answers().node_at(point);
  set(observer);
}

void MapAnswers::set(const Observer& observer) {
  if (observer.node.col >= answers().cols() || observer.node.row >= answers().rows())
    throw Error("the observer is outside the input");
  ViewshedTask task = answers().viewshed(observer);
  observer_ = observer;
  observer_->reach = task.reach;
  sight_.reset(), sight_to_.reset();
  std::vector<AnswerWorker::Pass> passes;
  const auto add = [&](double reach) {
    passes.emplace_back([this, reach, compute = task.compute](const Progress& progress) -> AnswerWorker::Show {
      auto seen = std::make_shared<SeenGround>(compute(reach, progress));
      return [this, seen] { seen_ = std::move(*seen); };
    });
  };
  if (task.quick_reach > 0) add(task.quick_reach);
  add(0);
  worker_.ask(std::move(passes));
}

void MapAnswers::unpin() {
  worker_.cancel();
  observer_.reset(), seen_.reset(), sight_.reset(), sight_to_.reset();
}

const SightAnswer* MapAnswers::sight_to(const std::optional<dvec3>& point) {
  if (!observer_ || !point) {
    sight_.reset(), sight_to_.reset();
    return nullptr;
  }
  if (sight_to_ != point) {
    sight_to_ = point;
    sight_.reset();
    try {
      sight_ = answers().sight(*observer_, *point);
    } catch (const Error&) {
      // no ground there, or too far for one plane: there is no line
    }
  }
  return sight_ ? &*sight_ : nullptr;
}

void MapAnswers::paint(PictureSettings& settings) const {
  if (seen_) settings.ground.drape = seen_->drape;
}

std::vector<std::string> MapAnswers::commands() const {
  std::vector<std::string> commands;
  if (observer_) commands.push_back(answers_->command(*observer_, "viewshed.tif"));
  if (horizon_) commands.push_back(answers_->horizon_command(*horizon_, "horizon.csv"));
  return commands;
}

void MapAnswers::toggle_horizon() {
  if (!shows_horizon_) answers();  // throws
  shows_horizon_ = !shows_horizon_;
  horizon_worker_.cancel();
  horizon_.reset(), horizon_node_.reset();
}

void MapAnswers::look_from(const std::optional<dvec3>& point) {
  if (!shows_horizon_ || !point) return;
  try {
    const Node node = answers().node_at(*point);
    if (horizon_node_ == node) return;
    horizon_node_ = node;
    horizon_worker_.ask({[this, task = answers().horizon(node)](const Progress& progress) -> AnswerWorker::Show {
      auto plot = std::make_shared<HorizonPlot>(task(progress));
      return [this, plot] { horizon_ = std::move(*plot); };
    }});
  } catch (const Error&) {
    horizon_.reset();  // no ground there
  }
}

std::vector<std::string> MapAnswers::lines() const {
  std::vector<std::string> lines;
  if (!observer_) return lines;
  lines.push_back(fmt::format("observer at column {}, row {}, eye {:.4g} m above ground", observer_->node.col,
                              observer_->node.row, observer_->height));
  if (seen_) {
    lines.push_back(fmt::format("sees {:.1f} % of the ground{}{}", 100 * seen_->share,
                                seen_->reach > 0 ? " within " + metres_text(seen_->reach) : "",
                                seen_->complete ? "" : " ..."));
  }
  if (!sight_) return lines;
  const LineOfSight& line = sight_->line;
  std::string text = fmt::format("cursor: {} away, ", metres_text(line.distance));
  text += line.visible ? "visible"
                       : fmt::format("hidden by ground after {}", metres_text(line.obstruction->along * line.distance));
  lines.push_back(text);
  if (std::isfinite(line.clearance))
    lines.push_back(
        fmt::format("clearance {:.2f} m at {}", line.clearance, metres_text(line.clearance_along * line.distance)));
  return lines;
}

}  // namespace scarp::viewer
