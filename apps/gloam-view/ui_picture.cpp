// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The picture and what is written over it: split screen, status, messages, progress, the pixel inspector.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "ui.h"
#include "ui_renderer.h"

namespace gloam::view {
namespace {

constexpr double kShownSeconds = 6.0, kProblemSeconds = 14.0;
constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255), kSoft = IM_COL32(225, 230, 238, 255);
constexpr ImU32 kShade = IM_COL32(14, 16, 19, 205), kLine = IM_COL32(255, 255, 255, 150);
constexpr ImU32 kAlarm = IM_COL32(236, 138, 112, 255);

ImGuiWindowFlags plain() {
  return ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
         ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing;
}

void tag(ImDrawList& list, ImVec2 at, const std::string& text, bool to_the_left, float scale) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 pad(8.0f * scale, 4.0f * scale);
  if (to_the_left) at.x -= size.x + 2.0f * pad.x;
  list.AddRectFilled(at, {at.x + size.x + 2.0f * pad.x, at.y + size.y + 2.0f * pad.y}, kShade, 3.0f * scale);
  list.AddText({at.x + pad.x, at.y + pad.y}, kSoft, text.c_str());
}

std::string rightName(const Session& session) {
  if (session.state.split == Split::kTechnique) return session.state.right.info->name;
  const ReferenceView* reference = session.reference();
  if (reference == nullptr) return "reference";
  std::string text =
      fmt::format("reference, {} sample{}", reference->samples, reference->samples == 1 ? "" : "s");
  if (reference->error)
    text += fmt::format(", error {:.1f} %, noise {:.1f} %", reference->error->relative_rmse * 100.0,
                        reference->noise * 100.0);
  return text;
}

void statusLine(const Session& session, const UiState& ui, const Place& place) {
  const float height = ImGui::GetIO().DisplaySize.y - place.size.y;
  if (height < 4.0f) return;
  ImGui::SetNextWindowPos({0.0f, place.size.y});
  ImGui::SetNextWindowSize({place.size.x, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12.0f * ui.scale, 6.0f * ui.scale});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  ImGui::Begin("status", nullptr, plain());
  if (const Drawn* drawn = session.drawn()) {
    const double ms =
        session.history().medianMs() > 0.0 ? session.history().medianMs() : drawn->left.frame_ms;
    std::string text = fmt::format("{}   {:.0f} ms   {} x {}   {}   panels {:.2f} ms", drawn->technique, ms,
                                   drawn->width, drawn->height, drawn->device.name, ui.ui_device_ms);
    if (session.duration_s() > 0.0f) text += fmt::format("   {:.2f} s", session.state.time_s);
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    fittedLine(text, place.size.x - 24.0f * ui.scale);
    ImGui::PopStyleColor();
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

/// The newest lowest, each whole: in as many lines as the picture's width asks for.
void messageList(const Session& session, const UiState& ui, const Place& place, float bottom) {
  constexpr int kMostShown = 3;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float margin = 16.0f * ui.scale, gap = 4.0f * ui.scale;
  const ImVec2 pad(8.0f * ui.scale, 4.0f * ui.scale);
  const float wrap = place.size.x - 2.0f * (margin + pad.x);
  if (wrap < 60.0f * ui.scale) return;
  int shown = 0;
  for (auto m = session.messages().rbegin(); m != session.messages().rend() && shown < kMostShown; ++m) {
    if (session.now_s() - m->at_s > (m->problem ? kProblemSeconds : kShownSeconds)) continue;
    const ImVec2 size = ImGui::CalcTextSize(m->text.c_str(), nullptr, false, wrap);
    const float height = size.y + 2.0f * pad.y;
    if (shown > 0 && bottom - height < gap) break;
    const ImVec2 low(margin, std::max(bottom - height, gap));  // the newest begins inside
    list.AddRectFilled(low, {low.x + size.x + 2.0f * pad.x, low.y + height}, kShade, 3.0f * ui.scale);
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {low.x + pad.x, low.y + pad.y},
                 m->problem ? kAlarm : kSoft, m->text.c_str(), nullptr, wrap);
    bottom = low.y - gap;
    ++shown;
  }
}

/// Height that it takes.
float progressBar(Session& session, const UiState& ui, const Place& place) {
  const Jobs::Status job = session.job();
  if (!job.busy || place.size.x < 140.0f * ui.scale || place.size.y < 90.0f * ui.scale) return 0.0f;
  const float height = 52.0f * ui.scale, width = std::min(place.size.x - 32.0f * ui.scale, 560.0f * ui.scale);
  ImGui::SetNextWindowPos({16.0f * ui.scale, place.size.y - height - 14.0f * ui.scale});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 4.0f * ui.scale);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12.0f * ui.scale, 7.0f * ui.scale});
  ImGui::Begin("progress", nullptr, plain());
  const float button = 70.0f * ui.scale;
  const std::string text = job.step.empty() ? job.what : fmt::format("{}: {}", job.what, job.step);
  ImGui::BeginGroup();
  fittedLine(text, width - button - 36.0f * ui.scale);
  ImGui::ProgressBar(float(job.fraction), {width - button - 36.0f * ui.scale, 8.0f * ui.scale}, "");
  ImGui::EndGroup();
  ImGui::SameLine();
  if (ImGui::Button("Stop", {button, 36.0f * ui.scale})) session.cancelJob();
  ImGui::End();
  ImGui::PopStyleVar(2);
  return height + 18.0f * ui.scale;
}

float playBar(Session& session, UiState& ui, const Place& place, float above) {
  const bool any = session.duration_s() > 0.0f || session.state.lights.moves();
  const float button = 64.0f * ui.scale, height = 40.0f * ui.scale;
  const float width = std::min(place.size.x - 32.0f * ui.scale, 560.0f * ui.scale);
  if (!any || width < button + 16.0f * ui.scale || place.size.y < height + above + 24.0f * ui.scale)
    return 0.0f;
  ImGui::SetNextWindowPos({16.0f * ui.scale, place.size.y - height - 14.0f * ui.scale - above});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowBgAlpha(0.85f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 4.0f * ui.scale);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8.0f * ui.scale, 8.0f * ui.scale});
  ImGui::Begin("play", nullptr, plain());
  if (ImGui::Button(session.playing ? "Pause" : "Play", {button, 0.0f})) session.play(!session.playing);
  noteControl(ui, "play");
  const bool wide = width >= 240.0f * ui.scale;  // narrow ones leave out the speed, then the time
  if (session.duration_s() > 0.0f && width >= 130.0f * ui.scale) {
    ImGui::SameLine();
    ImGui::SetNextItemWidth(wide ? -76.0f * ui.scale : -1.0f);
    float time_s = session.state.time_s;
    if (ImGui::SliderFloat("##time", &time_s, 0.0f, session.duration_s(), "%.2f s",
                           ImGuiSliderFlags_AlwaysClamp)) {
      session.playing = false;
      session.setTime(time_s);
    }
    noteControl(ui, "time");
  }
  if (wide) {
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::SliderFloat("##speed", &session.speed, 0.1f, 4.0f, "x %.2f", ImGuiSliderFlags_Logarithmic);
    noteControl(ui, "speed");
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  return height + 6.0f * ui.scale;
}

}  // namespace

void drawPicture(Session& session, const Place& place) {
  const Drawn* drawn = session.drawn();
  if (drawn == nullptr || drawn->left.rgba.empty()) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 low = place.low, high(place.low.x + place.size.x, place.low.y + place.size.y);
  list.AddImage(textureId(TextureSlot::kLeft), low, high);
  const bool right = drawn->split || (session.state.split == Split::kReference &&
                                      session.reference() != nullptr && session.reference()->layers);
  if (session.state.split == Split::kNone) return;
  const float scale = ImGui::GetFontSize() / 14.0f;
  const float x = std::round(low.x + place.size.x * session.divider);
  if (right)
    list.AddImage(textureId(TextureSlot::kRight), {x, low.y}, high, {session.divider, 0.0f}, {1.0f, 1.0f});
  list.AddLine({x, low.y}, {x, high.y}, kLine, 1.5f * scale);
  const float grip_y = low.y + place.size.y * 0.5f;
  list.AddRectFilled({x - 3.5f * scale, grip_y - 18.0f * scale}, {x + 3.5f * scale, grip_y + 18.0f * scale},
                     kWhite, 3.5f * scale);
  list.PushClipRect(low, {x, high.y}, true);
  tag(list, {low.x + 12.0f * scale, low.y + 12.0f * scale}, session.state.left.info->name, false, scale);
  list.PopClipRect();
  list.PushClipRect({x, low.y}, high, true);
  tag(list, {high.x - 12.0f * scale, low.y + 12.0f * scale}, rightName(session), true, scale);
  list.PopClipRect();
}

void drawOverlays(Session& session, UiState& ui, const Place& place) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  statusLine(session, ui, place);
  float taken = progressBar(session, ui, place);
  taken += playBar(session, ui, place, taken);
  messageList(session, ui, place, place.size.y - 12.0f * ui.scale - taken);
  ImGui::PopStyleVar();
  if (session.recording()) {
    const ImVec2 at(place.size.x - 22.0f * ui.scale, place.size.y - 22.0f * ui.scale);
    ImGui::GetBackgroundDrawList()->AddCircleFilled(at, 7.0f * ui.scale, IM_COL32(220, 70, 60, 255));
  }
}

namespace {

std::string colorText(const LayeredImage& layers, const char* layer, std::size_t at) {
  const Layer* found = layers.find(layer);
  if (found == nullptr || found->pixels.empty()) return "";
  const std::size_t n = found->channels.size();
  std::string text;
  for (std::size_t c = 0; c < std::min<std::size_t>(n, 3); ++c)
    text += fmt::format("{}{:.4g}", c > 0 ? "   " : "", found->pixels[at * n + c]);
  return text;
}

void inspected(const Drawn& drawn, int x, int y) {
  const LayeredImage& layers = *drawn.left.layers;
  const std::size_t at = std::size_t(y) * std::size_t(drawn.width) + std::size_t(x);
  ImGui::Text("%d, %d", x, y);
  if (!ImGui::BeginTable("values", 2, ImGuiTableFlags_SizingFixedFit)) return;
  const auto line = [&](const char* name, const std::string& text) {
    if (!text.empty()) valueRow(name, text);
  };
  line("radiance", colorText(layers, "", at));
  for (const char* name : {"direct", "indirect", "albedo", "normal", "depth"})
    line(name, colorText(layers, name, at));
  if (const Layer* objects = layers.find("object"); objects != nullptr && !objects->ids.empty())
    line("object", std::to_string(objects->ids[at]));
  if (drawn.right.layers && drawn.right.layers->width == drawn.width)
    line("right", colorText(*drawn.right.layers, "", at));
  if (!drawn.show.empty()) line("shown", colorText(layers, drawn.show.c_str(), at));
  ImGui::EndTable();
}

/// The neighbourhood, as large squares.
void magnified(const Drawn& drawn, int x, int y, float scale) {
  constexpr int kReach = 4;
  const float cell = 11.0f * scale;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (int j = -kReach; j <= kReach; ++j) {
    for (int i = -kReach; i <= kReach; ++i) {
      const int px = std::clamp(x + i, 0, drawn.width - 1), py = std::clamp(y + j, 0, drawn.height - 1);
      const std::uint8_t* c =
          &drawn.left.rgba[4 * (std::size_t(py) * std::size_t(drawn.width) + std::size_t(px))];
      const ImVec2 low(at.x + float(i + kReach) * cell, at.y + float(j + kReach) * cell);
      list.AddRectFilled(low, {low.x + cell, low.y + cell}, IM_COL32(c[0], c[1], c[2], 255));
    }
  }
  const ImVec2 middle(at.x + kReach * cell, at.y + kReach * cell);
  list.AddRect(middle, {middle.x + cell, middle.y + cell}, kWhite);
  ImGui::Dummy({cell * (2 * kReach + 1), cell * (2 * kReach + 1)});
}

}  // namespace

void drawInspector(Session& session, const UiState& ui, const Place& place) {
  const Drawn* drawn = session.drawn();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (!ui.inspector || drawn == nullptr || !drawn->left.layers || !place.holds(mouse) ||
      ImGui::GetIO().WantCaptureMouse)
    return;
  const int x =
      std::clamp(int((mouse.x - place.low.x) / place.size.x * float(drawn->width)), 0, drawn->width - 1);
  const int y =
      std::clamp(int((mouse.y - place.low.y) / place.size.y * float(drawn->height)), 0, drawn->height - 1);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {10.0f * ui.scale, 8.0f * ui.scale});
  ImGui::BeginTooltip();
  magnified(*drawn, x, y, ui.scale);
  inspected(*drawn, x, y);
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

}  // namespace gloam::view
