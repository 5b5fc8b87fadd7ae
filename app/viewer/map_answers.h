// SPDX-License-Identifier: MIT
// The observer that is pinned on the ground of the window, and the answers from there: the line of sight to the cursor
// and the viewshed, computed by a thread of its own and painted on the ground.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/answer_worker.h"
#include "app/viewer/ground_answers.h"
#include "app/viewer/picture_worker.h"
#include "app/viewer/subject.h"

namespace scarp::viewer {

class MapAnswers {
 public:
  /// `ready` is called on another thread when an answer is available.
  explicit MapAnswers(const std::function<void()>& ready) : worker_(ready), horizon_worker_(ready) {}

  /// The input has changed. The observer stays where it was, if the input can answer.
  void follow(const Subject& subject);

  /// Pins the observer at the sample nearest to a point in world metres. Throws Error, and then nothing has changed.
  void pin(const dvec3& point);
  /// Changes heights and reach of the pinned observer. Throws as pin().
  void set(const Observer& observer);
  void unpin();
  bool pinned() const { return observer_.has_value(); }
  const Observer& observer() const { return *observer_; }
  /// The ground under the pinned observer.
  dvec3 place() const { return answers_->point_at(observer_->node); }

  /// Shows the horizon under the cursor, or no longer. Throws Error for an input without answers.
  void toggle_horizon();
  bool shows_horizon() const { return shows_horizon_; }
  /// Computes the horizon of the sample nearest to a point, if it is shown.
  void look_from(const std::optional<dvec3>& point);
  /// The newest horizon; null: none.
  const HorizonPlot* horizon() const { return horizon_ ? &*horizon_ : nullptr; }
  /// Takes a new horizon over; returns whether there was one. Throws Error.
  bool deliver_horizon() { return horizon_worker_.deliver(); }

  /// Takes a new answer over; returns whether the picture changes. Throws Error.
  bool deliver() { return worker_.deliver(); }
  bool busy() const { return worker_.busy() || horizon_worker_.busy(); }
  /// The newest viewshed of the pinned observer; null: not yet known.
  const SeenGround* seen() const { return seen_ ? &*seen_ : nullptr; }

  /// The line of sight to a point of the ground. Nullptr without an observer and for points without an answer.
  const SightAnswer* sight_to(const std::optional<dvec3>& point);

  /// Paints the viewshed on the ground of a picture, in place of an overlay.
  void paint(PictureSettings& settings) const;
  /// The commands that write the answers: the map of the observer, the table of the horizon.
  std::vector<std::string> commands() const;
  /// Lines for readers: the observer, the line of sight, the share of ground that it sees.
  std::vector<std::string> lines() const;

 private:
  GroundAnswers& answers();

  const Subject* subject_ = nullptr;
  std::unique_ptr<GroundAnswers> answers_;  // opened by the first observer
  std::optional<Observer> observer_{};
  std::optional<SeenGround> seen_{};
  std::optional<SightAnswer> sight_{};
  std::optional<dvec3> sight_to_{};
  bool shows_horizon_ = false;
  std::optional<Node> horizon_node_{};
  std::optional<HorizonPlot> horizon_{};
  AnswerWorker worker_, horizon_worker_;  // end first
};

}  // namespace scarp::viewer
