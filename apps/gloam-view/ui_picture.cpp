// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The picture and what is written over it: split screen, status, messages, progress.
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

/// The first text that has room, in a corner. What was written.
std::string tag(ImDrawList& list, ImVec2 at, const std::vector<std::string>& texts, float room,
                bool to_the_left, float scale) {
  const ImVec2 pad(8.0f * scale, 4.0f * scale);
  for (const std::string& text : texts) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    if (size.x + 2.0f * pad.x > room) continue;
    if (to_the_left) at.x -= size.x + 2.0f * pad.x;
    list.AddRectFilled(at, {at.x + size.x + 2.0f * pad.x, at.y + size.y + 2.0f * pad.y}, kShade,
                       3.0f * scale);
    list.AddText({at.x + pad.x, at.y + pad.y}, kSoft, text.c_str());
    return text;
  }
  return "";
}

/// What the right half shows, the longest first.
std::vector<std::string> rightNames(const Session& session) {
  if (session.state.split == Split::kTechnique) return {session.state.right.info->name};
  const ReferenceView* reference = session.reference();
  const char* name = session.state.left.info->name;
  if (reference == nullptr && session.tracing())
    return {fmt::format("{}: the first sample of the reference is on its way", name),
            fmt::format("{}: reference to come", name), name};
  if (reference == nullptr)
    return {fmt::format("{}: the reference begins when it stands still", name),
            fmt::format("{}: reference to come", name), name};
  if (!reference->layers) return {fmt::format("{}: there is no reference", name), name};
  const std::string samples =
      fmt::format("reference, {} sample{}", reference->samples, reference->samples == 1 ? "" : "s");
  std::vector<std::string> texts = {samples, "reference"};
  if (reference->error) {
    const std::string error = percent(reference->error->relative_rmse, 1);
    texts.insert(texts.begin(), fmt::format("reference, error {}", error));
    texts.insert(texts.begin(),
                 fmt::format("{}, error {}, noise {}", samples, error, percent(reference->noise, 1)));
  }
  return texts;
}

/// Over the picture's upper left corner, below its tag: nothing else stands there.
void recordingMark(const Session& session, const Place& place, float scale) {
  const float top =
      place.low.y + 12.0f * scale + (session.state.split == Split::kNone ? 0.0f : tagHeight(scale));
  const ImVec2 low(place.low.x + 12.0f * scale, top);
  const std::string text = fmt::format("recording, {} frame{}", session.recordedFrames(),
                                       session.recordedFrames() == 1 ? "" : "s");
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float height = size.y + 8.0f * scale, dot = 22.0f * scale;
  const bool wide = size.x + dot + 32.0f * scale < place.size.x;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  list.AddRectFilled(low, {low.x + dot + (wide ? size.x + 8.0f * scale : 0.0f), low.y + height}, kShade,
                     3.0f * scale);
  list.AddCircleFilled({low.x + 0.5f * dot, low.y + 0.5f * height}, 5.5f * scale, IM_COL32(220, 70, 60, 255));
  if (wide) list.AddText({low.x + dot, low.y + 4.0f * scale}, kSoft, text.c_str());
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

/// The text in lines of that width, cut where it takes more than `most` of them.
std::string inLines(const std::string& text, float width, int most) {
  const ImFont& font = *ImGui::GetFont();
  const float scale = ImGui::GetFontSize() / font.FontSize;
  const char *at = text.data(), *end = text.data() + text.size();
  std::string lines;
  for (int line = 1; at < end; ++line) {
    if (line >= most) return lines + fitted({at, end}, width);
    const char* stop = font.CalcWordWrapPositionA(scale, at, end, width);
    if (stop <= at) stop = at + 1;
    lines.append(at, stop);
    for (at = stop; at < end && *at == ' '; ++at) {
    }
    if (at < end) lines += '\n';
  }
  return lines;
}

/// The newest lowest, together at most a third of the picture's height; one that was cut is shown whole under the mouse.
void messageList(const Session& session, const UiState& ui, const Place& place, float bottom) {
  constexpr int kMostShown = 3;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float margin = std::min(16.0f * ui.scale, 0.03f * place.size.x), gap = 4.0f * ui.scale;
  const ImVec2 pad(8.0f * ui.scale, 4.0f * ui.scale);
  const float wrap = place.size.x - 2.0f * (margin + pad.x), line = ImGui::GetTextLineHeight();
  float room = std::max(place.size.y / 3.0f, line + 2.0f * pad.y);
  if (wrap < 60.0f * ui.scale || bottom < line + 2.0f * pad.y + gap) return;
  int shown = 0;
  for (auto m = session.messages().rbegin(); m != session.messages().rend() && shown < kMostShown; ++m) {
    if (session.now_s() - m->at_s > (m->problem ? kProblemSeconds : kShownSeconds)) continue;
    const int most = int((std::min(room, bottom - gap) - 2.0f * pad.y) / line + 0.01f);
    if (most < 1) break;
    const std::string text = inLines(m->text, wrap, most);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float height = size.y + 2.0f * pad.y;
    const ImVec2 low(margin, bottom - height), high(margin + size.x + 2.0f * pad.x, bottom);
    list.AddRectFilled(low, high, kShade, 3.0f * ui.scale);
    list.AddText({low.x + pad.x, low.y + pad.y}, m->problem ? kAlarm : kSoft, text.c_str());
    const bool cut = text.ends_with("…") && !m->text.ends_with("…");
    if (cut && ImGui::IsMouseHoveringRect(low, high, false)) helpMark(m->text.c_str());
    bottom = low.y - gap;
    room -= height + gap;
    ++shown;
  }
}

/// Nobody knows how long it takes: a piece that goes to and fro.
void restlessBar(const ImVec2& size, double now_s) {
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float share = 0.2f, at = 0.5f * (1.0f - share) * (1.0f - std::cos(2.0f * float(now_s)));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = ImGui::GetStyle().FrameRounding;
  list.AddRectFilled(low, {low.x + size.x, low.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg), rounding);
  list.AddRectFilled({low.x + at * size.x, low.y}, {low.x + (at + share) * size.x, low.y + size.y},
                     ImGui::GetColorU32(ImGuiCol_PlotHistogram), rounding);
  ImGui::Dummy(size);
}

/// Height that it takes.
float progressBar(Session& session, const UiState& ui, const Place& place) {
  const Jobs::Status job = session.job();
  const std::string first = job.busy ? "" : session.firstPicture();
  if ((!job.busy && first.empty()) || place.size.x < 140.0f * ui.scale || place.size.y < 90.0f * ui.scale)
    return 0.0f;
  const float height = 52.0f * ui.scale, width = std::min(place.size.x - 32.0f * ui.scale, 560.0f * ui.scale);
  ImGui::SetNextWindowPos({16.0f * ui.scale, place.size.y - height - 14.0f * ui.scale});
  ImGui::SetNextWindowSize({width, height});
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 4.0f * ui.scale);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12.0f * ui.scale, 7.0f * ui.scale});
  ImGui::Begin("progress", nullptr, plain());
  if (job.busy) {
    const float button = 70.0f * ui.scale, bar = width - button - 36.0f * ui.scale;
    ImGui::BeginGroup();
    fittedLine(job.step.empty() ? job.what : fmt::format("{}: {}", job.what, job.step), bar);
    ImGui::ProgressBar(float(job.fraction), {bar, 8.0f * ui.scale}, "");
    ImGui::EndGroup();
    ImGui::SameLine();
    if (ImGui::Button("Stop", {button, 36.0f * ui.scale})) session.cancelJob();
  } else {
    fittedLine(first, width - 28.0f * ui.scale);
    restlessBar({width - 28.0f * ui.scale, 8.0f * ui.scale}, session.now_s());
  }
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

float tagHeight(float scale) {
  return ImGui::GetTextLineHeight() + 14.0f * scale;
}

void drawPicture(Session& session, UiState& ui, const Place& place) {
  ui.right_tag.clear();
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
  tag(list, {low.x + 12.0f * scale, low.y + 12.0f * scale}, {session.state.left.info->name},
      x - low.x - 18.0f * scale, false, scale);
  list.PopClipRect();
  list.PushClipRect({x, low.y}, high, true);
  ui.right_tag = tag(list, {high.x - 12.0f * scale, low.y + 12.0f * scale}, rightNames(session),
                     high.x - x - 18.0f * scale, true, scale);
  list.PopClipRect();
}

void drawOverlays(Session& session, UiState& ui, const Place& place) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  statusLine(session, ui, place);
  float taken = progressBar(session, ui, place);
  taken += playBar(session, ui, place, taken);
  messageList(session, ui, place, place.size.y - 12.0f * ui.scale - taken);
  ImGui::PopStyleVar();
  if (session.recording()) recordingMark(session, place, ui.scale);
}

}  // namespace gloam::view
