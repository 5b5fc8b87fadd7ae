// SPDX-License-Identifier: MIT
#include "app/viewer/panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/viewer/kept_settings.h"
#include "app/viewer/keys.h"
#include "app/viewer/scaled.h"
#include "app/viewer/verdict_text.h"

namespace scarp::viewer {
namespace {

constexpr std::array<const char*, 4> kModes = {"orbit", "fly", "walk", "top"};
constexpr std::array<const char*, 5> kPasses = {"moving", "coarse", "full resolution", "refining", "complete"};
// Pixels at a scale of 1.
constexpr float kControlWidth = 160, kHelpWidth = 350, kProfileHeight = 70;

void draw_wrapped(const std::string& text, float width = 0) {
  ImGui::PushTextWrapPos(width);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

void explain_item(const std::string& text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  draw_wrapped(text, scaled(kHelpWidth));
  ImGui::EndTooltip();
}

// A line that is no wider than the panel: its middle is cut, and a tooltip has all of it.
void draw_line(const std::string& text) {
  const std::string line = fitted(text, ImGui::GetContentRegionAvail().x);
  ImGui::TextUnformatted(line.c_str());
  if (line != text) explain_item(text);
}

// The label of a control, no wider than the rest of the panel. Dear ImGui takes the text after ### as the control's
// name.
std::string label_of(const std::string& label, float control) {
  const float room = ImGui::GetContentRegionAvail().x - control - ImGui::GetStyle().ItemInnerSpacing.x;
  const std::string line = fitted(label, room);
  return line == label ? label : line + "###" + label;
}

void draw_help(bool& open) {
  if (!open) return;
  const float margin = scaled(kMargin);
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - margin, margin}, ImGuiCond_Appearing, {1, 0});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {std::max(ImGui::GetIO().DisplaySize.x - 2 * margin, 1.0f),
                                               std::max(ImGui::GetIO().DisplaySize.y - 2 * margin, 1.0f)});
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

// The order in which Tab goes through the controls: that in which they are drawn.
class TabOrder {
 public:
  explicit TabOrder(PanelState& state) : state_(state), to_(state.tabs == 0 ? -1 : state.focused + state.tabs) {}
  // Numbers of controls wrap around.
  ~TabOrder() {
    if (state_.keyboard && state_.tabs != 0 && !found_) {
      wrap();
      return;
    }
    state_.tabs = 0;
    if (!state_.keyboard) state_.focused = -1;
  }
  TabOrder(const TabOrder&) = delete;
  TabOrder& operator=(const TabOrder&) = delete;

  // Call after each control was drawn.
  void add() {
    const ImGuiID item = ImGui::GetItemID();
    if (!state_.keyboard || item == 0) return;
    if (count_ == to_ && state_.tabs != 0) {
      ImGui::SetFocusID(item, ImGui::GetCurrentWindow());
      ImGui::GetCurrentContext()->NavDisableHighlight = false;
      ImGui::SetScrollHereY();
      state_.focused = count_;
      found_ = true;
    } else if (state_.tabs == 0 && ImGui::IsItemFocused()) {
      state_.focused = count_;  // arrows have moved it
    }
    ++count_;
  }

 private:
  // Tab after the last control goes to the first in the next frame.
  void wrap() {
    state_.focused = state_.tabs > 0 ? -1 : count_;
    state_.tabs = count_ > 0 ? (state_.tabs > 0 ? 1 : -1) : 0;
  }

  PanelState& state_;
  int to_, count_ = 0;
  bool found_ = false;
};

// Sliders whose value may be typed, after Ctrl and click.
class Sliders {
 public:
  Sliders(PanelState& state, PanelActions& actions, TabOrder& order)
      : state_(state), actions_(actions), order_(order) {}

  // Returns whether to apply the value.
  bool draw(const std::string& name, Control& control, double& value, double least, double most) {
    TypedValue& typed = state_.typed;
    const std::string id = control.option + name, text = label_of(name, ImGui::CalcItemWidth());
    const char* const label = text.c_str();
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
    const bool changed = applies(control, moved, state_.reopens);
    order_.add();
    if (!state_.keyboard || !ImGui::IsItemFocused()) return changed;
    state_.on_slider = true;
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false)) {
      begin(id, number_text(control, value));
      typed.focuses = true;
      ImGui::ClearActiveID();  // Enter has activated the slider, whose name the field takes over
    }
    return changed;
  }
  TabOrder& order() { return order_; }

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
    if (std::exchange(state_.typed.focuses, false)) ImGui::SetKeyboardFocusHere();
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
  TabOrder& order_;
};

// A list, whose parts are no wider than the panel. Call ImGui::EndCombo() if it is open.
bool begin_list(const std::string& label, const std::string& choice, TabOrder& order) {
  const float width = ImGui::CalcItemWidth(), arrow = ImGui::GetFrameHeight() + ImGui::GetStyle().FramePadding.x;
  const std::string shown = fitted(choice, width - arrow);
  const bool open = ImGui::BeginCombo(label_of(label, width).c_str(), shown.c_str());
  if (open) return true;
  order.add();
  if (shown != choice) explain_item(choice);
  return false;
}

bool draw_choice(Control& control, bool close, TabOrder& order) {
  bool changed = false;
  if (!begin_list(control.label, control.choice, order)) return false;
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
  const bool moved = ImGui::DragFloatRange2(label_of(control.label, ImGui::CalcItemWidth()).c_str(), &low, &high, step,
                                            static_cast<float>(control.least), static_cast<float>(control.most), "%.4g",
                                            nullptr, ImGuiSliderFlags_AlwaysClamp);
  if (moved) control.numbers = {low, high, 0};
  return low < high && applies(control, moved, reopens);
}

bool draw_check(const std::string& label, bool& on, TabOrder& order) {
  const bool changed = ImGui::Checkbox(label_of(label, ImGui::GetFrameHeight()).c_str(), &on);
  order.add();
  return changed;
}

// Returns whether the option's value changed.
bool draw_value(Control& control, const PanelState& state, Sliders& sliders) {
  switch (control.kind) {
    case ControlKind::flag:
      return draw_check(control.label, control.on, sliders.order());
    case ControlKind::choice:
      return draw_choice(control, state.close_lists, sliders.order());
    case ControlKind::number:
      return sliders.draw(control.label, control, control.numbers[0], control.least, control.most);
    case ControlKind::pair:
      return draw_pair(control, state.reopens);
    case ControlKind::angles: {
      const bool azimuth = sliders.draw(control.label + " azimuth", control, control.numbers[0], 0, 360);
      ImGui::SetNextItemWidth(scaled(kControlWidth));
      const bool altitude = sliders.draw(control.label + " altitude", control, control.numbers[1], 0, 90);
      return azimuth || altitude;
    }
    case ControlKind::colour:
      break;
  }
  float rgb[3];
  std::copy(control.numbers.begin(), control.numbers.end(), rgb);
  const bool moved =
      ImGui::ColorEdit3(label_of(control.label, ImGui::GetFrameHeight()).c_str(), rgb, ImGuiColorEditFlags_NoInputs);
  if (moved) std::copy_n(rgb, 3, control.numbers.begin());
  return applies(control, moved, state.reopens);
}

bool draw_control(Control& control, const PanelState& state, Sliders& sliders) {
  ImGui::PushID(control.option.c_str());
  bool changed = false;
  if (control.may_rest) {
    bool given = !control.rests;
    if (draw_check(given ? "##given" : control.label, given, sliders.order())) {
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
  explain_item(control.option + ": " + control.help);
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
    const bool unfolded = ImGui::TreeNodeEx(std::string(cli::heading_of(topic)).c_str(), open);
    sliders.order().add();
    if (!unfolded) continue;
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
  if (sliders.draw(control.label, control, fov, kLeast, kMost)) actions.fov_deg = fov;
  if (is_reset()) actions.fov_deg = state.first_fov_deg;
}

std::optional<std::string> draw_comparisons(const PanelState& state, TabOrder& order) {
  constexpr const char* kNothing = "nothing";
  std::optional<std::string> chosen;
  ImGui::SetNextItemWidth(scaled(kControlWidth));
  if (!begin_list("compare with", state.compared.empty() ? kNothing : state.compared, order)) return {};
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
  draw_line(fmt::format("{}, {} x {}{}{}", pass, image.width, image.height, time, state.busy ? " ..." : ""));
  for (std::size_t i = 0; state.times && shown.sides.size() > 1 && i < shown.side_seconds.size(); ++i) {
    draw_line(fmt::format("{}: {:.0f} ms", i < state.names.size() ? state.names[i] : "", 1e3 * shown.side_seconds[i]));
  }
  if (state.times && image.width > 0 && shown.seconds > 0) {
    constexpr double kMillion = 1e6;
    const double pixels = static_cast<double>(image.width) * image.height * static_cast<double>(shown.sides.size());
    draw_line(fmt::format("{:.2g} million pixels per second on {}", pixels / kMillion / shown.seconds, state.device));
  }
  if (!state.verdict) return;
  for (std::size_t i = 0; i < state.verdict->sides.size(); ++i) {
    const std::string text = verdict_text(state.verdict->sides[i]);
    if (text.empty()) continue;
    const bool named = state.verdict->sides.size() > 1 && i < state.names.size();
    draw_wrapped((named ? state.names[i] + ": " : "") + text);
  }
}

void draw_reading(PanelState& state) {
  std::vector<std::string> lines{"nothing under the cursor"};
  if (state.reading) lines = state.reading->lines;
  for (std::size_t i = 0; i < state.pixel.size(); ++i) {
    const bool named = state.pixel.size() > 1 && i < state.names.size();
    lines.push_back((named ? state.names[i] + ": " : "") + pixel_text(state.pixel[i]));
  }
  state.reading_lines = std::max(state.reading_lines, lines.size());
  lines.resize(state.reading_lines);
  for (const std::string& line : lines) draw_line(line);
  if (state.measures) ImGui::TextUnformatted("click both ends of a line");
  if (!state.line) return;
  draw_wrapped(fmt::format("{:.1f} m, rises {:.1f} m; the ends {}", state.line->flat, state.line->rise,
                           state.line->sees ? "see one another" : "are hidden from one another"));
  ImGui::PlotLines("##profile", state.line->heights.data(), static_cast<int>(state.line->heights.size()), 0, nullptr,
                   FLT_MAX, FLT_MAX, {ImGui::GetContentRegionAvail().x, scaled(kProfileHeight)});
}

void draw_buttons(PanelState& state, PanelActions& actions, TabOrder& order) {
  actions.save = ImGui::Button("Save picture (P)");
  order.add();
  ImGui::SameLine();
  actions.copy = ImGui::Button("Copy command (C)");
  order.add();
  ImGui::SameLine();
  if (ImGui::Button("Help (F1)")) state.help = !state.help;
  order.add();
}

void draw_modes(const PanelState& state, PanelActions& actions, TabOrder& order) {
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    const auto mode = static_cast<MoveMode>(i);
    if (ImGui::RadioButton(kModes[i], state.mode == mode)) actions.mode = mode;
    order.add();
  }
  if (state.mode == MoveMode::fly || state.mode == MoveMode::walk) ImGui::Text("%.1f m/s", state.speed);
}

void draw_text_size(const PanelState& state, PanelActions& actions, TabOrder& order) {
  const auto name = [](double size) { return fmt::format("{:.0f} %", 100 * size); };
  ImGui::SetNextItemWidth(scaled(kControlWidth));
  if (!begin_list("size of text", name(state.text), order)) return;
  if (state.close_lists) ImGui::CloseCurrentPopup();
  for (const double size : kTextSizes) {
    if (ImGui::Selectable(name(size).c_str(), size == state.text) && size != state.text) actions.text = size;
  }
  ImGui::EndCombo();
}

// Beside the picture it has a column of the window; over the picture it is as low as its content, and can be moved.
void place_panel(PanelState& state, const WindowLayout& layout) {
  const float margin = scaled(kMargin), height = ImGui::GetIO().DisplaySize.y;
  const auto width = static_cast<float>(layout.panel_width);
  const bool was_beside = std::exchange(state.beside, layout.beside);
  if (layout.beside) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({width, height});
    ImGui::SetNextWindowCollapsed(false);
    return;
  }
  ImGui::SetNextWindowPos({margin, margin}, was_beside ? ImGuiCond_Always : ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, std::max(height - 2 * margin, 1.0f)});
  ImGui::SetNextWindowBgAlpha(0.8f);
}

}  // namespace

std::string fitted(const std::string& text, float width) {
  const auto width_of = [](const std::string& line) { return ImGui::CalcTextSize(line.c_str()).x; };
  if (width_of(text) <= width) return text;
  // Starts of characters: UTF-8 is not cut within one.
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) starts.push_back(i);
  }
  // Names differ at their beginnings, and numbers follow them.
  for (std::size_t kept = starts.size() - 1; kept > 0; --kept) {
    const std::size_t tail = kept / 2, head = kept - tail;
    const std::string line =
        text.substr(0, starts[head]) + "..." + (tail > 0 ? text.substr(starts[starts.size() - tail]) : "");
    if (width_of(line) <= width) return line;
  }
  return "...";
}

void let_panel_have_keys(const PanelState& state) {
  ImGuiIO& io = ImGui::GetIO();
  io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
  if (state.keyboard) io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  if (!state.keyboard) {
    ImGui::GetCurrentContext()->NavDisableHighlight = true;
    return;
  }
  // Enter does what Space does, but types into sliders.
  if (!state.on_slider && ImGui::IsKeyDown(ImGui::GetKeyIndex(ImGuiKey_Enter)))
    io.NavInputs[ImGuiNavInput_Activate] = 1;
}

PanelActions draw_panel(PanelState& state, const WindowLayout& layout) {
  PanelActions actions;
  state.on_slider = false;
  place_panel(state, layout);
  const ImGuiWindowFlags flags = layout.beside
                                     ? ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                           ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoBringToFrontOnFocus
                                     : ImGuiWindowFlags_AlwaysAutoResize;
  if (ImGui::Begin("Scarp", nullptr, flags)) {
    TabOrder order(state);
    Sliders sliders(state, actions, order);
    draw_reading(state);
    ImGui::Separator();
    draw_buttons(state, actions, order);
    ImGui::Separator();
    draw_modes(state, actions, order);
    draw_fov(state, sliders, actions);
    actions.change = draw_controls(state, sliders);
    actions.compare = draw_comparisons(state, order);
    draw_text_size(state, actions, order);
    ImGui::Separator();
    draw_cost(state);  // at the end: its lines come and go, and controls stay where they are
    if (!state.message.text.empty()) draw_wrapped(state.message.text);
  }
  ImGui::End();
  draw_help(state.help);
  state.close_lists = false;
  return actions;
}

}  // namespace scarp::viewer
