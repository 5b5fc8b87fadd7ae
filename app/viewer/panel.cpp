// SPDX-License-Identifier: MIT
#include "app/viewer/panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/viewer/keys.h"
#include "app/viewer/scaled.h"
#include "app/viewer/verdict_text.h"

namespace scarp::viewer {
namespace {

constexpr std::array<const char*, 4> kModes = {"orbit", "fly", "walk", "top"};
constexpr std::array<const char*, 5> kPasses = {"moving", "coarse", "full resolution", "refining", "complete"};
// Pixels at a scale of 1.
constexpr float kControlWidth = 160, kTextWidth = 350, kProfileHeight = 70;

void draw_wrapped(const std::string& text) {
  ImGui::PushTextWrapPos(scaled(kTextWidth));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

void draw_help(bool& open) {
  if (!open) return;
  const float margin = scaled(kMargin);
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - margin, margin}, ImGuiCond_Appearing, {1, 0});
  if (ImGui::Begin("Mouse and keys", &open, ImGuiWindowFlags_AlwaysAutoResize)) {
    for (const HelpLine& line : help_lines()) {
      ImGui::TextUnformatted(line.input.c_str());
      ImGui::SameLine(scaled(kControlWidth));
      ImGui::TextUnformatted(line.effect);
    }
  }
  ImGui::End();
}

using Reopens = std::function<bool(const OptionChange&)>;

// Whether to apply the control's new value, after its slider was drawn: while it moves, or, if the input has to be
// reopened, when the mouse is released.
bool applies(const Control& control, bool moved, const Reopens& reopens) {
  const bool released = ImGui::IsItemDeactivatedAfterEdit();
  return (moved || released) && (reopens(change_of(control)) ? released : moved);
}

// Whether the item that was drawn last shall have its default again.
bool is_reset() { return ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0) && !ImGui::GetIO().KeyCtrl; }

// Sliders whose value may be typed, after Ctrl and click.
class Sliders {
 public:
  Sliders(PanelState& state, PanelActions& actions) : state_(state), actions_(actions) {}

  // Returns whether to apply the value.
  bool draw(const char* label, Control& control, double& value, double least, double most) {
    TypedValue& typed = state_.typed;
    const std::string id = control.option + label;
    if (typed.id != id && clicked_to_type()) begin(id, number_text(control, value));
    if (typed.id == id) return draw_field(label, control, value);
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput |
                                   (control.logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    bool moved;
    const std::string unit = control.unit.empty() ? "" : (control.unit == "\u00b0" ? "" : " ") + control.unit;
    if (control.whole) {
      int number = static_cast<int>(std::lround(value));
      moved = ImGui::SliderInt(label, &number, static_cast<int>(least), static_cast<int>(most), ("%d" + unit).c_str(),
                               flags);
      if (moved) value = number;
    } else {
      auto number = static_cast<float>(value);
      moved = ImGui::SliderFloat(label, &number, static_cast<float>(least), static_cast<float>(most),
                                 ("%.4g" + unit).c_str(), flags);
      if (moved) value = number;
    }
    return applies(control, moved, state_.reopens);
  }

 private:
  static std::string number_text(const Control& control, double value) {
    return control.whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
  }

  void begin(const std::string& id, const std::string& text) { state_.typed = {id, text, text}; }

  // Whether the slider that is drawn next was clicked for typing.
  static bool clicked_to_type() {
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const ImVec2 to{from.x + ImGui::CalcItemWidth(), from.y + ImGui::GetFrameHeight()};
    if (!ImGui::IsWindowHovered() || !ImGui::IsMouseHoveringRect(from, to)) return false;
    return ImGui::IsMouseClicked(0) && ImGui::GetIO().KeyCtrl;
  }

  // The click that began it activates the field. A wrong text leaves the value as it was.
  bool draw_field(const char* label, const Control& control, double& value) {
    TypedValue& typed = state_.typed;
    std::array<char, 32> text{};
    std::copy_n(typed.text.begin(), std::min(typed.text.size(), text.size() - 1), text.begin());
    const bool entered = ImGui::InputText(label, text.data(), text.size(),
                                          ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    typed.text = text.data();
    const bool left = ImGui::IsItemDeactivated();
    if (state_.close_lists || ((left || entered) && typed.text == typed.was)) {
      typed = {};
      return false;
    }
    if (!entered && !left) return false;
    const std::optional<double> number = typed_number(typed.text);
    const bool good = number && (!control.whole || *number == std::round(*number));
    if (good) {
      value = *number;
    } else {
      actions_.error = fmt::format("{} '{}': expected {}", control.option, typed.text,
                                   control.whole ? "a whole number" : "a number such as 1.5 or 1,5");
    }
    typed = {};
    return good;
  }

  PanelState& state_;
  PanelActions& actions_;
};

bool draw_choice(Control& control, bool close) {
  bool changed = false;
  if (!ImGui::BeginCombo(control.label.c_str(), control.choice.c_str())) return false;
  if (close) ImGui::CloseCurrentPopup();
  for (const std::string& choice : control.choices) {
    if (ImGui::Selectable(choice.c_str(), choice == control.choice) && choice != control.choice) {
      control.choice = choice;
      changed = true;
    }
  }
  ImGui::EndCombo();
  return changed;
}

bool draw_pair(Control& control, const Reopens& reopens) {
  auto low = static_cast<float>(control.numbers[0]), high = static_cast<float>(control.numbers[1]);
  const float step = std::max((high - low) / 200, 0.01f);
  const bool moved =
      ImGui::DragFloatRange2(control.label.c_str(), &low, &high, step, static_cast<float>(control.least),
                             static_cast<float>(control.most), "%.4g", nullptr, ImGuiSliderFlags_AlwaysClamp);
  if (moved) control.numbers = {low, high, 0};
  return low < high && applies(control, moved, reopens);
}

// Returns whether the option's value changed.
bool draw_value(Control& control, const PanelState& state, Sliders& sliders) {
  switch (control.kind) {
    case ControlKind::flag:
      return ImGui::Checkbox(control.label.c_str(), &control.on);
    case ControlKind::choice:
      return draw_choice(control, state.close_lists);
    case ControlKind::number:
      return sliders.draw(control.label.c_str(), control, control.numbers[0], control.least, control.most);
    case ControlKind::pair:
      return draw_pair(control, state.reopens);
    case ControlKind::angles: {
      const bool azimuth = sliders.draw((control.label + " azimuth").c_str(), control, control.numbers[0], 0, 360);
      ImGui::SetNextItemWidth(scaled(kControlWidth));
      const bool altitude = sliders.draw((control.label + " altitude").c_str(), control, control.numbers[1], 0, 90);
      return azimuth || altitude;
    }
    case ControlKind::colour:
      break;
  }
  float rgb[3];
  std::copy(control.numbers.begin(), control.numbers.end(), rgb);
  const bool moved = ImGui::ColorEdit3(control.label.c_str(), rgb, ImGuiColorEditFlags_NoInputs);
  if (moved) std::copy_n(rgb, 3, control.numbers.begin());
  return applies(control, moved, state.reopens);
}

bool draw_control(Control& control, const PanelState& state, Sliders& sliders) {
  ImGui::PushID(control.option.c_str());
  bool changed = false;
  if (control.may_rest) {
    bool given = !control.rests;
    if (ImGui::Checkbox(given ? "##given" : control.label.c_str(), &given)) {
      control.rests = !given;
      changed = true;
    }
    if (!control.rests) ImGui::SameLine();
  }
  if (!control.rests) {
    const float box = control.may_rest ? ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x : 0;
    ImGui::SetNextItemWidth(scaled(kControlWidth) - box);
    changed |= draw_value(control, state, sliders);
    control.reset = control.kind != ControlKind::flag && control.kind != ControlKind::choice && is_reset();
  }
  if (ImGui::IsItemHovered()) {
    ImGui::BeginTooltip();
    draw_wrapped(control.option + ": " + control.help);
    ImGui::EndTooltip();
  }
  ImGui::PopID();
  return changed;
}

// The common options, then the others under the headings of their topics.
std::optional<OptionChange> draw_controls(PanelState& state, Sliders& sliders) {
  std::vector<Control>& controls = state.controls;
  std::optional<OptionChange> change;
  const auto draw = [&](Control& control) {
    if (draw_control(control, state, sliders)) change = change_of(control);
    if (control.reset) change = OptionChange{control.option, {}};
  };
  for (Control& control : controls) {
    if (control.common) draw(control);
  }
  for (int i = 0; i < cli::kTopics; ++i) {
    const auto topic = static_cast<cli::Topic>(i);
    const auto is_here = [&](const Control& control) { return control.topic == topic && !control.common; };
    if (std::none_of(controls.begin(), controls.end(), is_here)) continue;
    const ImGuiTreeNodeFlags open = topic == cli::Topic::march ? ImGuiTreeNodeFlags_DefaultOpen : 0;
    if (!ImGui::TreeNodeEx(std::string(cli::heading_of(topic)).c_str(), open)) continue;
    for (Control& control : controls) {
      if (is_here(control)) draw(control);
    }
    ImGui::TreePop();
  }
  return change;
}

// All modes but the map have a field of view.
void draw_fov(const PanelState& state, Sliders& sliders, PanelActions& actions) {
  constexpr double kLeast = 10, kMost = 120;  // of the slider
  if (state.mode == MoveMode::top) return;
  Control control{.option = "--fov", .label = "field of view", .unit = "\u00b0"};
  double fov = state.fov_deg;
  ImGui::SetNextItemWidth(scaled(kControlWidth));
  if (sliders.draw(control.label.c_str(), control, fov, kLeast, kMost)) actions.fov_deg = fov;
  if (is_reset()) actions.fov_deg = state.first_fov_deg;
}

std::optional<std::string> draw_comparisons(const PanelState& state) {
  constexpr const char* kNothing = "nothing";
  std::optional<std::string> chosen;
  ImGui::SetNextItemWidth(scaled(kControlWidth));
  if (!ImGui::BeginCombo("compare with", state.compared.empty() ? kNothing : state.compared.c_str())) return {};
  if (state.close_lists) ImGui::CloseCurrentPopup();
  if (ImGui::Selectable(kNothing, state.compared.empty())) chosen = "";
  for (const std::string& with : state.comparisons) {
    if (ImGui::Selectable(with.c_str(), with == state.compared)) chosen = with;
  }
  ImGui::EndCombo();
  return chosen;
}

void draw_cost(const PanelState& state) {
  if (!state.shown || state.shown->sides.empty()) return;
  const WorkedPicture& shown = *state.shown;
  const Image& image = shown.sides.front().image;
  std::string pass = kPasses[static_cast<std::size_t>(shown.pass)];
  if (shown.pass == PicturePass::refining) {
    pass += fmt::format(" (aa {}", shown.aa);
    pass += shown.samples > 0 ? fmt::format(", {} samples)", shown.samples) : ")";
  }
  const std::string time = state.times ? fmt::format(", {:.0f} ms", 1e3 * shown.seconds) : std::string();
  ImGui::Text("%s, %d x %d%s%s", pass.c_str(), image.width, image.height, time.c_str(), state.busy ? " ..." : "");
  if (state.times && image.width > 0 && shown.seconds > 0) {
    constexpr double kMillion = 1e6;
    ImGui::Text("%.2g million pixels per second on %s",
                static_cast<double>(image.width) * image.height * static_cast<double>(shown.sides.size()) / kMillion /
                    shown.seconds,
                state.device.c_str());
  }
  if (!state.verdict) return;
  for (std::size_t i = 0; i < state.verdict->sides.size(); ++i) {
    const std::string text = verdict_text(state.verdict->sides[i]);
    if (text.empty()) continue;
    const bool named = state.verdict->sides.size() > 1 && i < state.names.size();
    draw_wrapped((named ? state.names[i] + ": " : "") + text);
  }
}

void draw_reading(const PanelState& state) {
  if (state.reading) {
    for (const std::string& line : state.reading->lines) ImGui::TextUnformatted(line.c_str());
  } else {
    ImGui::TextUnformatted("nothing under the cursor");
  }
  if (state.measures) ImGui::TextUnformatted("click both ends of a line");
  if (!state.line) return;
  draw_wrapped(fmt::format("{:.1f} m, rises {:.1f} m; the ends {}", state.line->flat, state.line->rise,
                           state.line->sees ? "see one another" : "are hidden from one another"));
  ImGui::PlotLines("##profile", state.line->heights.data(), static_cast<int>(state.line->heights.size()), 0, nullptr,
                   FLT_MAX, FLT_MAX, {scaled(kTextWidth), scaled(kProfileHeight)});
}

}  // namespace

PanelActions draw_panel(PanelState& state) {
  PanelActions actions;
  const float margin = scaled(kMargin);
  ImGui::SetNextWindowPos({margin, margin}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints({0, 0}, {FLT_MAX, std::max(ImGui::GetIO().DisplaySize.y - 2 * margin, 1.0f)});
  ImGui::SetNextWindowBgAlpha(0.8f);
  if (ImGui::Begin("Scarp", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    for (std::size_t i = 0; i < kModes.size(); ++i) {
      if (i > 0) ImGui::SameLine();
      const auto mode = static_cast<MoveMode>(i);
      if (ImGui::RadioButton(kModes[i], state.mode == mode)) actions.mode = mode;
    }
    Sliders sliders(state, actions);
    draw_fov(state, sliders, actions);
    actions.change = draw_controls(state, sliders);
    actions.compare = draw_comparisons(state);
    if (state.mode == MoveMode::fly || state.mode == MoveMode::walk) ImGui::Text("%.1f m/s", state.speed);
    ImGui::Separator();
    draw_cost(state);
    ImGui::Separator();
    draw_reading(state);
    ImGui::Separator();
    actions.save = ImGui::Button("Save picture (P)");
    ImGui::SameLine();
    actions.copy = ImGui::Button("Copy command (C)");
    ImGui::SameLine();
    if (ImGui::Button("Help (F1)")) state.help = !state.help;
    if (!state.message.text.empty()) draw_wrapped(state.message.text);
  }
  ImGui::End();
  draw_help(state.help);
  state.close_lists = false;
  return actions;
}

}  // namespace scarp::viewer
