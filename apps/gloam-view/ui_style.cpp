// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ui.h"

namespace gloam::view {
namespace {

constexpr const char* kLetters[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"};

ImVec4 grey(float value, float alpha = 1.0f) {
  return {value, value * 1.03f, value * 1.08f, alpha};
}

}  // namespace

void loadLetters(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  static const ImWchar kRanges[] = {0x20, 0xff, 0x2010, 0x2027, 0x2190, 0x2193, 0x25a0, 0x25c0, 0};
  for (const char* file : kLetters) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) continue;
    if (io.Fonts->AddFontFromFileTTF(file, std::max(6.0f, std::round(14.0f * scale)), nullptr, kRanges))
      return;
  }
  ImFontConfig config;
  config.SizePixels = 13.0f * scale;
  io.Fonts->AddFontDefault(&config);
}

void setStyle(float scale) {
  ImGuiStyle style;
  ImGui::StyleColorsDark(&style);
  style.WindowPadding = {14.0f, 12.0f};
  style.FramePadding = {8.0f, 4.0f};
  style.ItemSpacing = {8.0f, 6.0f};
  style.ItemInnerSpacing = {6.0f, 4.0f};
  style.ScrollbarSize = 10.0f;
  style.GrabMinSize = 10.0f;
  style.WindowBorderSize = style.FrameBorderSize = 0.0f;
  style.WindowRounding = 0.0f;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = 3.0f;
  style.ScrollbarRounding = 5.0f;
  style.IndentSpacing = 12.0f;
  const ImVec4 accent(0.35f, 0.55f, 0.74f, 1.0f), accent_soft(0.35f, 0.55f, 0.74f, 0.55f);
  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = grey(0.87f);
  c[ImGuiCol_TextDisabled] = grey(0.56f);
  c[ImGuiCol_WindowBg] = grey(0.105f);
  c[ImGuiCol_PopupBg] = grey(0.13f, 0.98f);
  c[ImGuiCol_Border] = grey(0.2f);
  c[ImGuiCol_FrameBg] = grey(0.165f);
  c[ImGuiCol_FrameBgHovered] = grey(0.2f);
  c[ImGuiCol_FrameBgActive] = grey(0.23f);
  c[ImGuiCol_SliderGrab] = {0.35f, 0.55f, 0.74f, 0.7f};  // its number stays legible
  c[ImGuiCol_SliderGrabActive] = {0.45f, 0.66f, 0.86f, 1.0f};
  c[ImGuiCol_CheckMark] = {0.45f, 0.66f, 0.86f, 1.0f};
  c[ImGuiCol_Button] = grey(0.19f);
  c[ImGuiCol_ButtonHovered] = grey(0.25f);
  c[ImGuiCol_ButtonActive] = accent_soft;
  c[ImGuiCol_Header] = grey(0.145f);
  c[ImGuiCol_HeaderHovered] = grey(0.185f);
  c[ImGuiCol_HeaderActive] = grey(0.21f);
  c[ImGuiCol_Separator] = grey(0.2f);
  c[ImGuiCol_PlotLines] = accent;
  c[ImGuiCol_PlotHistogram] = accent;
  c[ImGuiCol_ScrollbarBg] = {0.0f, 0.0f, 0.0f, 0.0f};
  c[ImGuiCol_ScrollbarGrab] = grey(0.24f);
  c[ImGuiCol_TableHeaderBg] = grey(0.14f);
  c[ImGuiCol_TableRowBgAlt] = grey(0.16f, 0.5f);
  c[ImGuiCol_TextSelectedBg] = accent_soft;
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
}

Place layOut(const UiState& ui, const ImVec2& window) {
  const float panel = 372.0f * ui.scale, status = 28.0f * ui.scale;
  Place place;
  place.size = window;
  if (ui.panel && window.x > panel * 1.6f) place.size.x -= panel;
  if (ui.panel && window.y > status * 6.0f) place.size.y -= status;
  return place;
}

void label(const char* text, const char* help) {
  const float column = ImGui::GetFontSize() * 8.4f;
  const float start = ImGui::GetCursorPosX();
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  if (help != nullptr && *help != '\0' && ImGui::IsItemHovered()) helpMark(help);
  ImGui::SameLine(start + column);
  ImGui::SetNextItemWidth(-1.0f);
}

void helpMark(const char* help) {
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24.0f);
  ImGui::TextUnformatted(help);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void helpBeside(const char* help) {
  const ImVec2 at(ImGui::GetWindowPos().x - ImGui::GetStyle().ItemSpacing.x, ImGui::GetItemRectMin().y);
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, {1.0f, 0.0f});
  helpMark(help);
}

void valueRow(const char* name, const std::string& value) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  ImGui::TextUnformatted(name);
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(value.c_str());
}

void dim(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

std::string fitted(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string cut = text;
  do {
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xc0) == 0x80) cut.pop_back();
    if (!cut.empty()) cut.pop_back();  // a whole letter
  } while (!cut.empty() && ImGui::CalcTextSize((cut + "…").c_str()).x > width);
  return cut + "…";
}

void fittedLine(const std::string& text, float width) {
  const std::string shown = fitted(text, width);
  ImGui::TextUnformatted(shown.c_str());
  if (shown != text && ImGui::IsItemHovered()) helpMark(text.c_str());
}

std::string percent(double share, int digits) {
  return std::isfinite(share) ? fmt::format("{:.{}f} %", share * 100.0, digits) : "–";
}

void noteControl(UiState& ui, const std::string& name) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  ui.controls[name] = {low, {high.x - low.x, high.y - low.y}};
}

bool inputPath(const char* id, std::string& text, float width) {
  char buffer[1024] = {};
  text.copy(buffer, sizeof buffer - 1);
  ImGui::SetNextItemWidth(width);
  const bool entered = ImGui::InputText(id, buffer, sizeof buffer, ImGuiInputTextFlags_EnterReturnsTrue);
  text = buffer;
  return entered;
}

}  // namespace gloam::view
