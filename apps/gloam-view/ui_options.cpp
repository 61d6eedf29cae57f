// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A control for every option of a technique, by its declaration: what the table gains, the viewer has.
#include <fmt/core.h>

#include <algorithm>

#include "ui.h"

namespace gloam::view {
namespace {

std::string spaced(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string textOf(const OptionValue& value) {
  return std::visit([](const auto& held) { return fmt::format("{}", held); }, value);
}

/// Small values get as much of the slider as large ones. Where 0 is one of them, it keeps the left end for itself.
bool isWide(const Option& option) {
  const double least = std::holds_alternative<int>(option.default_value) ? 1.0 : 1e-3;
  return option.minimum >= 0.0 && option.maximum > 100.0 * std::max(option.minimum, least);
}

void flagControl(Session& session, Side side, const Option& option) {
  bool value = session.wanted[side].settings.flag(option.name);
  if (ImGui::Checkbox(fmt::format("##{}", option.name).c_str(), &value))
    session.setOption(side, option.name, value ? "true" : "false");
}

void integerControl(Session& session, Side side, const Option& option) {
  int value = session.wanted[side].settings.integer(option.name);
  const bool wide = isWide(option);
  if (ImGui::SliderInt(fmt::format("##{}", option.name).c_str(), &value, int(option.minimum),
                       int(option.maximum), "%d",
                       ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0)))
    session.setOption(side, option.name, std::to_string(value));
}

void numberControl(Session& session, Side side, const Option& option) {
  float value = session.wanted[side].settings.number(option.name);
  const bool wide = isWide(option);
  if (ImGui::SliderFloat(fmt::format("##{}", option.name).c_str(), &value, float(option.minimum),
                         float(option.maximum), "%.3g",
                         ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0)))
    session.setOption(side, option.name, fmt::format("{}", value));
}

void choiceControl(Session& session, Side side, const Option& option) {
  const std::string value = session.wanted[side].settings.choice(option.name);
  if (!ImGui::BeginCombo(fmt::format("##{}", option.name).c_str(), value.c_str())) return;
  for (const char* choice : option.choices) {
    if (ImGui::Selectable(choice, value == choice)) session.setOption(side, option.name, choice);
  }
  ImGui::EndCombo();
}

}  // namespace

void optionControls(Session& session, UiState& ui, Side side) {
  ImGui::PushID(side);
  const TechniqueInfo& info = *session.wanted[side].info;
  for (const Option& option : info.options) {
    const std::string name = spaced(option.name);
    const std::string help = fmt::format("{}\n\nby default {}; a right click sets it\n--{}.{}", option.help,
                                         textOf(option.default_value), info.name, option.name);
    label(name.c_str(), help.c_str());
    if (std::holds_alternative<bool>(option.default_value)) {
      flagControl(session, side, option);
    } else if (std::holds_alternative<int>(option.default_value)) {
      integerControl(session, side, option);
    } else if (std::holds_alternative<float>(option.default_value)) {
      numberControl(session, side, option);
    } else {
      choiceControl(session, side, option);
    }
    noteControl(ui, fmt::format("{}.{}", side == kLeft ? info.name : "right", option.name));
    if (ImGui::IsItemHovered() && ImGui::IsMouseReleased(ImGuiMouseButton_Right))
      session.setOption(side, option.name, textOf(option.default_value));
  }
  ImGui::PopID();
}

}  // namespace gloam::view
