// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Mouse over the picture, and keys (docs/viewer.md lists them).
#include <GLFW/glfw3.h>
#include <fmt/core.h>
#include <imgui_internal.h>  // ClosePopupToLevel

#include <algorithm>
#include <cmath>

#include "file_names.h"
#include "ui.h"

namespace gloam::view {
namespace {

constexpr float kRadiansAPixel = 0.006f, kClickPixels = 4.0f;

float times(const std::vector<int>& keys, int key) {
  return float(std::ranges::count(keys, key));
}
bool among(const std::vector<int>& keys, int key) {
  return std::ranges::find(keys, key) != keys.end();
}

bool onDivider(const Session& session, const Place& place, const ImVec2& at, float scale) {
  if (session.state.split == Split::kNone || !place.holds(at)) return false;
  return std::abs(at.x - place.low.x - session.divider * place.size.x) < 7.0f * scale;
}

/// What the button that is down holds, decided where it went down.
enum class Grip { kNone, kPicture, kDivider, kElsewhere };

void drag(Session& session, const Place& place, Grip grip, int button) {
  const ImGuiIO& io = ImGui::GetIO();
  if (grip == Grip::kDivider) {
    session.divider = std::clamp((io.MousePos.x - place.low.x) / std::max(place.size.x, 1.0f), 0.0f, 1.0f);
    return;
  }
  const glm::vec2 moved(io.MouseDelta.x, io.MouseDelta.y);
  if (grip != Grip::kPicture || (moved.x == 0.0f && moved.y == 0.0f)) return;
  if (button == ImGuiMouseButton_Right) {
    session.camera.look({moved.x * kRadiansAPixel * 0.6f, -moved.y * kRadiansAPixel * 0.6f});
  } else if (button == ImGuiMouseButton_Middle || io.KeyShift) {
    session.camera.pan({-moved.x / std::max(place.size.y, 1.0f), moved.y / std::max(place.size.y, 1.0f)});
  } else {
    session.camera.orbit({moved.x * kRadiansAPixel, moved.y * kRadiansAPixel});
  }
  session.changed();
}

void mouse(Session& session, UiState& ui, const Place& place, bool gizmo_has_mouse) {
  const ImGuiIO& io = ImGui::GetIO();
  static Grip grips[3] = {};
  bool any = false;
  for (int button = 0; button < 3; ++button) {
    Grip& grip = grips[button];
    if (ImGui::IsMouseClicked(button)) {
      const bool mine = place.holds(io.MousePos) && !io.WantCaptureMouse && !gizmo_has_mouse;
      grip = !mine                                                             ? Grip::kElsewhere
             : button == 0 && onDivider(session, place, io.MousePos, ui.scale) ? Grip::kDivider
                                                                               : Grip::kPicture;
    }
    if (io.MouseDown[button]) {  // where it went down it came from elsewhere: that is no drag
      if (!ImGui::IsMouseClicked(button)) drag(session, place, grip, button);
      any |= grip == Grip::kPicture;
    } else {
      const ImVec2 from = io.MouseClickedPos[button];
      const float far = std::hypot(io.MousePos.x - from.x, io.MousePos.y - from.y);
      if (grip == Grip::kPicture && button == 0 && ImGui::IsMouseReleased(button) && far < kClickPixels &&
          place.size.x > 0.0f) {
        const int light = lightAt(session, place, io.MousePos, ui.scale);
        if (light != kNone) {
          session.choose(light);
        } else {
          session.clickAt(
              {(io.MousePos.x - place.low.x) / place.size.x, (io.MousePos.y - place.low.y) / place.size.y});
        }
      }
      grip = Grip::kNone;
    }
  }
  session.dragging = any || gizmo_has_mouse;
  if (place.holds(io.MousePos) && !io.WantCaptureMouse && io.MouseWheel != 0.0f) {
    session.camera.zoom(io.MouseWheel);
    session.changed();
  }
  if (onDivider(session, place, io.MousePos, ui.scale) && !io.WantCaptureMouse)
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
}

void fly(Session& session) {
  const ImGuiIO& io = ImGui::GetIO();
  glm::vec3 way(0.0f);
  const auto held = [](int key) { return ImGui::IsKeyDown(key) ? 1.0f : 0.0f; };
  way.x = held(GLFW_KEY_D) - held(GLFW_KEY_A);
  way.y = held(GLFW_KEY_E) - held(GLFW_KEY_Q);
  way.z = held(GLFW_KEY_W) - held(GLFW_KEY_S);
  if (way == glm::vec3(0.0f) || io.KeyCtrl) return;
  const float speed = session.camera.sceneSize() * 0.25f * (io.KeyShift ? 4.0f : 1.0f);
  session.camera.fly(way * speed * std::min(io.DeltaTime, 0.1f));
  session.changed();
}

void lightKeys(Session& session, const UiState& ui) {
  ViewState& state = session.state;
  const float stops =
      0.25f * times(ui.repeated, GLFW_KEY_RIGHT_BRACKET) - 0.25f * times(ui.repeated, GLFW_KEY_LEFT_BRACKET);
  const float degrees =
      5.0f * times(ui.repeated, GLFW_KEY_PERIOD) - 5.0f * times(ui.repeated, GLFW_KEY_COMMA);
  if (stops == 0.0f && degrees == 0.0f) return;
  state.display.exposure_stops = std::clamp(state.display.exposure_stops + stops, -50.0f, 50.0f);
  state.env_rotation_deg = std::remainder(state.env_rotation_deg + degrees, 360.0f);
  session.changed();
}

void timeKeys(Session& session, const UiState& ui) {
  if (among(ui.pressed, GLFW_KEY_SPACE)) session.play(!session.playing);
  const float step = 1.0f * times(ui.repeated, GLFW_KEY_RIGHT) - 1.0f * times(ui.repeated, GLFW_KEY_LEFT);
  if (step == 0.0f || session.duration_s() <= 0.0f) return;
  session.playing = false;
  session.setTime(session.state.time_s + step / 30.0f);
}

/// Keys overwrite nothing.
void fileKeys(Session& session, UiState& ui) {
  if (among(ui.pressed, GLFW_KEY_F2)) session.saveWhole(freeName(ui.screenshot));
  if (among(ui.pressed, GLFW_KEY_F3))
    session.recording() ? session.stopVideo() : session.startVideo(freeName(ui.video));
  if (among(ui.pressed, GLFW_KEY_F5)) session.savePreset(ui.last_preset = freeName(ui.preset));
  if (among(ui.pressed, GLFW_KEY_F9)) session.loadPreset(ui.last_preset.empty() ? ui.preset : ui.last_preset);
}

void keys(Session& session, UiState& ui) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool lists = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);  // Esc closes them, and nothing else
  if (lists && std::erase(ui.pressed, GLFW_KEY_ESCAPE) > 0) ImGui::ClosePopupToLevel(0, false);
  if (io.WantTextInput) return;
  if (among(ui.pressed, GLFW_KEY_TAB)) ui.panel = !ui.panel;
  if (among(ui.pressed, GLFW_KEY_F)) session.frameScene();
  if (among(ui.pressed, GLFW_KEY_G)) ui.turns = !ui.turns;
  if (among(ui.pressed, GLFW_KEY_C)) session.setSplit(Split((int(session.state.split) + 1) % 3));
  if (among(ui.pressed, GLFW_KEY_ESCAPE)) session.choose(kNone);
  if (among(ui.pressed, GLFW_KEY_I)) session.inspect(ui.inspector = !ui.inspector);
  fileKeys(session, ui);
  for (std::size_t i = 0; i < std::min<std::size_t>(techniques().size(), 9); ++i) {
    if (among(ui.pressed, GLFW_KEY_1 + int(i))) session.pick(kLeft, techniques()[i].name);
  }
  timeKeys(session, ui);
  lightKeys(session, ui);
  fly(session);
}

}  // namespace

void handleInput(Session& session, UiState& ui, const Place& place, bool gizmo_has_mouse) {
  mouse(session, ui, place, gizmo_has_mouse);
  keys(session, ui);
}

}  // namespace gloam::view
