// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Handles of what is selected (gizmo.h) and marks of lights, drawn by lines over the picture.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>

#include "ui.h"

namespace gloam::view {
namespace {

constexpr ImU32 kColors[3] = {IM_COL32(222, 96, 88, 255), IM_COL32(126, 196, 96, 255),
                              IM_COL32(92, 148, 230, 255)};
constexpr ImU32 kSoftColors[3] = {IM_COL32(222, 96, 88, 90), IM_COL32(126, 196, 96, 90),
                                  IM_COL32(92, 148, 230, 90)};
constexpr ImU32 kBright = IM_COL32(255, 232, 150, 255), kRim = IM_COL32(12, 14, 18, 150);

/// Places of the picture in the window.
class Pen {
 public:
  Pen(const Place& place, float scale) : low_(place.low), scale_(scale) {}
  void line(const glm::vec2& a, const glm::vec2& b, ImU32 color) const {
    list_.AddLine(at(a), at(b), color, 2.5f * scale_);
  }
  void dot(const glm::vec2& p, float radius, ImU32 color) const {
    list_.AddCircleFilled(at(p), radius * scale_, color);
  }
  template <std::size_t kCount>
  void polygon(const std::array<glm::vec2, kCount>& points, ImU32 color, float thickness) const {
    std::array<ImVec2, kCount> placed;
    std::ranges::transform(points, placed.begin(), [this](const glm::vec2& p) { return at(p); });
    if (thickness > 0.0f) {
      list_.AddPolyline(placed.data(), int(kCount), color, ImDrawFlags_Closed, thickness * scale_);
    } else {
      list_.AddConvexPolyFilled(placed.data(), int(kCount), color);
    }
  }

 private:
  ImVec2 at(const glm::vec2& p) const { return {low_.x + p.x, low_.y + p.y}; }
  ImDrawList& list_ = *ImGui::GetBackgroundDrawList();
  ImVec2 low_;
  float scale_;
};

void drawHandles(const Handles& handles, const Handle& lit, const Place& place) {
  const Pen pen(place, handles.scale);
  using Kind = Handle::Kind;
  const glm::vec2 centre = handles.onScreen(handles.origin);
  const auto isLit = [&](Kind kind, int axis) { return lit.kind == kind && lit.axis == axis; };
  for (int axis = 0; axis < 3; ++axis) {
    if (handles.turns) {
      const bool bright = isLit(Kind::kRing, axis);
      pen.polygon(handles.ring(axis), bright ? kBright : kColors[axis], bright ? 3.0f : 2.0f);
      continue;
    }
    pen.polygon(handles.square(axis), isLit(Kind::kPlane, axis) ? kBright : kSoftColors[axis], 0.0f);
    const ImU32 color = isLit(Kind::kAxis, axis) ? kBright : kColors[axis];
    pen.line(centre, handles.tip(axis), color);
    pen.dot(handles.tip(axis), 5.0f, color);
  }
  const bool held = lit.kind == Kind::kCentre;
  pen.dot(centre, held ? 7.0f : 6.0f, kRim);
  pen.dot(centre, held ? 6.0f : 4.5f, held ? kBright : IM_COL32(240, 240, 240, 255));
}

std::optional<glm::vec3> placeOf(const Session& session) {
  const Drawn& drawn = *session.drawn();
  const LoadedScene& loaded = *session.state.scene;
  for (std::size_t i = 0; i < std::min(loaded.light_nodes.size(), drawn.lights.size()); ++i) {
    if (loaded.light_nodes[i] == session.selectedNode()) return drawn.lights[i].position;
  }
  glm::vec3 sum(0.0f);
  int count = 0;
  for (std::size_t i = 0; i < std::min(loaded.instance_nodes.size(), drawn.instance_places.size()); ++i) {
    if (loaded.instance_nodes[i] == session.selectedNode()) sum += drawn.instance_places[i], ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / float(count);
}

void pullOn(Session& session, UiState& ui, const glm::vec2& mouse) {
  const auto moves = ui.pull->to(session.state.scene->scene, mouse);
  if (!moves || *moves == session.state.moves) return;  // held still, it stands still
  session.state.moves = *moves;
  session.changed();
}

/// What was moved since the handle was taken goes back; the handle stays let go until the button is.
void putBack(Session& session, UiState& ui) {
  session.state.moves = ui.pull->before();
  session.changed();
  ui.pull.reset();
  ui.let_go = true;
}

/// Handles, and what the mouse does with them. True while it is theirs.
bool drawSelected(Session& session, UiState& ui, const Place& place) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!io.MouseDown[0]) ui.pull.reset(), ui.let_go = false;
  if (ui.pull && std::erase(ui.pressed, GLFW_KEY_ESCAPE) > 0) putBack(session, ui);
  const std::optional<glm::vec3> at = ui.pull ? ui.pull->place() : placeOf(session);
  if (!at || place.size.y <= 1.0f) return ui.let_go;
  const Handles handles{session.camera.posed(), {place.size.x, place.size.y}, *at, ui.turns, ui.scale};
  if (project(handles.camera, *at, handles.size).z <= 0.0f) return ui.let_go || ui.pull.has_value();
  const glm::vec2 mouse(io.MousePos.x - place.low.x, io.MousePos.y - place.low.y);
  const Handle under = ui.pull ? ui.pull->handle() : ui.let_go ? Handle{} : handleAt(handles, mouse);
  drawHandles(handles, under, place);
  if (!ui.pull && under && place.holds(io.MousePos) && ImGui::IsMouseClicked(0) && !io.WantCaptureMouse)
    ui.pull.emplace(handles, under, session.selectedNode(), session.state.moves, mouse);
  if (ui.pull) pullOn(session, ui, mouse);
  return ui.let_go || ui.pull.has_value();
}

bool isNear(const LightMark& mark, const ImVec2& at, float scale) {
  return std::hypot(mark.at.x - at.x, mark.at.y - at.y) < 10.0f * scale;
}

/// In the light's colour, with a dark rim that stands out from bright walls; brighter under the mouse.
void drawLightMarks(const Session& session, const Place& place, float scale,
                    const std::optional<Pull>& pull) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  for (LightMark mark : lightMarks(session, place)) {
    if (pull && mark.node == session.selectedNode()) {  // with the hand, not with the picture
      const glm::vec3 p = project(session.camera.posed(), pull->place(), {place.size.x, place.size.y});
      mark.at = {place.low.x + p.x, place.low.y + p.y};
    }
    const bool lit = !ImGui::GetIO().WantCaptureMouse && isNear(mark, mouse, scale);
    const ImU32 color = lit ? kBright : ImGui::GetColorU32({mark.color.x, mark.color.y, mark.color.z, 1.0f});
    list.AddCircleFilled(mark.at, 4.0f * scale, color);
    list.AddCircle(mark.at, 8.5f * scale, kRim, 24, 3.5f * scale);
    list.AddCircle(mark.at, 8.5f * scale, color, 24, 1.5f * scale);
    if (mark.node == session.selectedNode())
      list.AddCircle(mark.at, 14.0f * scale, kBright, 32, 2.0f * scale);
  }
}

}  // namespace

std::vector<LightMark> lightMarks(const Session& session, const Place& place) {
  std::vector<LightMark> marks;
  const Drawn* drawn = session.drawn();
  if (drawn == nullptr || !session.state.scene) return marks;
  const std::vector<int>& nodes = session.state.scene->light_nodes;
  const PosedCamera camera = session.camera.posed();
  for (std::size_t i = 0; i < std::min(nodes.size(), drawn->lights.size()); ++i) {
    const PosedLight& light = drawn->lights[i];
    const glm::vec3 p = project(camera, light.position, {place.size.x, place.size.y});
    if (p.z <= 0.0f) continue;
    const glm::vec3& sent = light.light.intensity;
    const float most = std::max({sent.x, sent.y, sent.z, 1e-6f});
    marks.push_back({nodes[i], {place.low.x + p.x, place.low.y + p.y}, 0.35f + 0.65f * sent / most});
  }
  return marks;
}

int lightAt(const Session& session, const Place& place, const ImVec2& at, float scale) {
  for (const LightMark& mark : lightMarks(session, place)) {
    if (isNear(mark, at, scale)) return mark.node;
  }
  return kNone;
}

bool drawGizmo(Session& session, UiState& ui, const Place& place) {
  const bool selected = session.drawn() != nullptr && session.state.scene && session.selectedNode() != kNone;
  if (!selected) ui.pull.reset(), ui.let_go = false;
  if (!selected && !ui.panel) return false;  // the picture alone
  ImGui::GetBackgroundDrawList()->PushClipRect(place.low,
                                               {place.low.x + place.size.x, place.low.y + place.size.y});
  drawLightMarks(session, place, ui.scale, ui.pull);
  const bool mine = selected && drawSelected(session, ui, place);
  ImGui::GetBackgroundDrawList()->PopClipRect();
  return mine;
}

}  // namespace gloam::view
