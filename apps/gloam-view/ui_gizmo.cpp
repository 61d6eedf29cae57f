// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Handles of a thing or a light: arrows along the axes, squares for planes, rings to turn it. Drawn by lines over the picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "ui.h"

namespace gloam::view {
namespace {

constexpr float kReachPixels = 84.0f, kNearPixels = 7.0f;
constexpr int kRingPoints = 48;
constexpr ImU32 kColors[3] = {IM_COL32(222, 96, 88, 255), IM_COL32(126, 196, 96, 255),
                              IM_COL32(92, 148, 230, 255)};
constexpr ImU32 kSoftColors[3] = {IM_COL32(222, 96, 88, 90), IM_COL32(126, 196, 96, 90),
                                  IM_COL32(92, 148, 230, 90)};
constexpr ImU32 kBright = IM_COL32(255, 232, 150, 255), kRim = IM_COL32(12, 14, 18, 150);

enum class Kind { kNone, kAxis, kPlane, kRing };

/// What the mouse holds since it went down.
struct Held {
  Kind kind = Kind::kNone;
  int axis = 0;
  int node = kNone;
  glm::vec3 origin{0.0f}, start{0.0f};
  float start_value = 0.0f;
  NodeEdits before;
  glm::vec3 moved{0.0f};
};
Held held;

struct Stage {
  const Place& place;
  PosedCamera camera;
  glm::vec3 origin;
  float reach;  ///< metres
  glm::vec2 size() const { return {place.size.x, place.size.y}; }
  ImVec2 onScreen(const glm::vec3& world) const {
    const glm::vec3 p = project(camera, world, size());
    return {place.low.x + p.x, place.low.y + p.y};
  }
  Ray mouseRay() const {
    const ImVec2 m = ImGui::GetIO().MousePos;
    return rayThrough(camera, {m.x - place.low.x, m.y - place.low.y}, size());
  }
};

glm::vec3 axisOf(int i) {
  glm::vec3 axis(0.0f);
  axis[i] = 1.0f;
  return axis;
}

float distanceToSegment(const ImVec2& p, const ImVec2& a, const ImVec2& b) {
  const glm::vec2 ab(b.x - a.x, b.y - a.y), ap(p.x - a.x, p.y - a.y);
  const float t = std::clamp(glm::dot(ap, ab) / std::max(glm::dot(ab, ab), 1e-6f), 0.0f, 1.0f);
  return glm::length(ap - ab * t);
}

/// Along the axis, the place that is nearest to the ray.
float alongAxis(const Ray& ray, const glm::vec3& origin, const glm::vec3& axis) {
  const glm::vec3 w = origin - ray.origin;
  const float b = glm::dot(axis, ray.direction), d = glm::dot(axis, w), e = glm::dot(ray.direction, w);
  const float denominator = 1.0f - b * b;
  return denominator < 1e-5f ? 0.0f : (b * e - d) / denominator;
}

std::optional<glm::vec3> onPlane(const Ray& ray, const glm::vec3& origin, const glm::vec3& normal) {
  const float facing = glm::dot(ray.direction, normal);
  if (std::abs(facing) < 1e-4f) return std::nullopt;
  const float t = glm::dot(origin - ray.origin, normal) / facing;
  if (t <= 0.0f) return std::nullopt;
  return ray.origin + ray.direction * t;
}

float angleOnRing(const glm::vec3& point, const glm::vec3& origin, int axis) {
  const glm::vec3 d = point - origin;
  return std::atan2(d[(axis + 2) % 3], d[(axis + 1) % 3]);
}

std::array<ImVec2, kRingPoints> ringOf(const Stage& stage, int axis) {
  std::array<ImVec2, kRingPoints> points;
  for (int i = 0; i < kRingPoints; ++i) {
    const float angle = 2.0f * std::numbers::pi_v<float> * float(i) / kRingPoints;
    glm::vec3 p(0.0f);
    p[(axis + 1) % 3] = std::cos(angle) * stage.reach;
    p[(axis + 2) % 3] = std::sin(angle) * stage.reach;
    points[std::size_t(i)] = stage.onScreen(stage.origin + p);
  }
  return points;
}

std::array<ImVec2, 4> squareOf(const Stage& stage, int axis) {
  const glm::vec3 a = axisOf((axis + 1) % 3) * stage.reach, b = axisOf((axis + 2) % 3) * stage.reach;
  const auto at = [&](float u, float v) { return stage.onScreen(stage.origin + a * u + b * v); };
  return {at(0.28f, 0.28f), at(0.5f, 0.28f), at(0.5f, 0.5f), at(0.28f, 0.5f)};
}

bool within(const std::array<ImVec2, 4>& square, const ImVec2& p) {
  bool positive = false, negative = false;
  for (int i = 0; i < 4; ++i) {
    const ImVec2 a = square[std::size_t(i)], b = square[std::size_t((i + 1) % 4)];
    const float side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    (side >= 0.0f ? positive : negative) = true;
  }
  return positive != negative;
}

struct Hover {
  Kind kind = Kind::kNone;
  int axis = 0;
};

Hover hoverOf(const Stage& stage, bool turns, float scale) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  Hover best;
  float nearest = kNearPixels * scale;
  for (int axis = 0; axis < 3; ++axis) {
    if (turns) {
      const auto ring = ringOf(stage, axis);
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const float d = distanceToSegment(mouse, ring[i], ring[(i + 1) % ring.size()]);
        if (d < nearest) nearest = d, best = {Kind::kRing, axis};
      }
      continue;
    }
    if (within(squareOf(stage, axis), mouse)) return {Kind::kPlane, axis};
    const glm::vec3 tip = stage.origin + axisOf(axis) * stage.reach;
    const float d = distanceToSegment(mouse, stage.onScreen(stage.origin), stage.onScreen(tip));
    if (d < nearest) nearest = d, best = {Kind::kAxis, axis};
  }
  return best;
}

void drawHandles(const Stage& stage, bool turns, const Hover& hover, float scale) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (int axis = 0; axis < 3; ++axis) {
    const bool lit = hover.kind != Kind::kNone && hover.axis == axis;
    if (turns) {
      const auto ring = ringOf(stage, axis);
      list.AddPolyline(ring.data(), kRingPoints, lit ? kBright : kColors[axis], ImDrawFlags_Closed,
                       (lit ? 3.0f : 2.0f) * scale);
      continue;
    }
    const auto square = squareOf(stage, axis);
    list.AddConvexPolyFilled(square.data(), 4,
                             lit && hover.kind == Kind::kPlane ? kBright : kSoftColors[axis]);
    const ImU32 color = lit && hover.kind == Kind::kAxis ? kBright : kColors[axis];
    const ImVec2 from = stage.onScreen(stage.origin),
                 to = stage.onScreen(stage.origin + axisOf(axis) * stage.reach);
    list.AddLine(from, to, color, 2.5f * scale);
    list.AddCircleFilled(to, 5.0f * scale, color);
  }
  list.AddCircleFilled(stage.onScreen(stage.origin), 4.0f * scale, IM_COL32(240, 240, 240, 255));
}

std::optional<glm::vec3> placeOf(const Session& session) {
  const Drawn& drawn = *session.drawn();
  const LoadedScene& loaded = *session.state.scene;
  for (std::size_t i = 0; i < std::min(loaded.light_nodes.size(), drawn.lights.size()); ++i) {
    if (loaded.light_nodes[i] == session.selected_node) return drawn.lights[i].position;
  }
  glm::vec3 sum(0.0f);
  int count = 0;
  for (std::size_t i = 0; i < std::min(loaded.instance_nodes.size(), drawn.instance_places.size()); ++i) {
    if (loaded.instance_nodes[i] == session.selected_node) sum += drawn.instance_places[i], ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / float(count);
}

void take(const Session& session, const Stage& stage, const Hover& hover) {
  held = {hover.kind, hover.axis, session.selected_node, stage.origin, {}, 0.0f, session.state.edits, {}};
  const glm::vec3 axis = axisOf(hover.axis);
  const Ray ray = stage.mouseRay();
  if (hover.kind == Kind::kAxis) held.start_value = alongAxis(ray, stage.origin, axis);
  held.start = onPlane(ray, stage.origin, axis).value_or(stage.origin);
  if (hover.kind == Kind::kRing) held.start_value = angleOnRing(held.start, stage.origin, hover.axis);
}

void pull(Session& session, const Stage& stage) {
  const glm::vec3 axis = axisOf(held.axis);
  const Ray ray = stage.mouseRay();
  glm::mat4 motion(1.0f);
  if (held.kind == Kind::kAxis) {
    held.moved = axis * (alongAxis(ray, held.origin, axis) - held.start_value);
    motion = glm::translate(glm::mat4(1.0f), held.moved);
  } else {
    const std::optional<glm::vec3> point = onPlane(ray, held.origin, axis);
    if (!point) return;
    if (held.kind == Kind::kPlane) {
      held.moved = *point - held.start;
      motion = glm::translate(glm::mat4(1.0f), held.moved);
    } else {
      const float angle = angleOnRing(*point, held.origin, held.axis) - held.start_value;
      motion = glm::translate(glm::mat4(1.0f), held.origin) * glm::rotate(glm::mat4(1.0f), angle, axis) *
               glm::translate(glm::mat4(1.0f), -held.origin);
    }
  }
  NodeEdits edits = held.before;
  moveNode(session.state.scene->scene, edits, held.node, motion);
  session.state.edits = std::move(edits);
  session.changed();
}

/// Handles, and what the mouse does with them. True while it is theirs.
bool drawSelected(Session& session, const UiState& ui, const Place& place) {
  const std::optional<glm::vec3> at = held.kind == Kind::kNone ? placeOf(session) : held.origin + held.moved;
  bool mine = false;
  if (at && place.size.y > 1.0f) {
    Stage stage{place, session.camera.posed(), *at, 0.0f};
    const glm::vec3 seen = project(stage.camera, *at, stage.size());
    const Camera& camera = stage.camera.camera;
    const float half =
        camera.perspective ? std::tan(camera.vertical_fov_rad * 0.5f) * seen.z : camera.half_height;
    stage.reach = kReachPixels * ui.scale * 2.0f * half / place.size.y;
    if (seen.z > 0.0f) {
      const bool free = held.kind == Kind::kNone;
      const Hover hover = free ? hoverOf(stage, ui.turns, ui.scale) : Hover{held.kind, held.axis};
      drawHandles(stage, ui.turns, hover, ui.scale);
      const bool over = hover.kind != Kind::kNone && place.holds(ImGui::GetIO().MousePos);
      if (free && over && ImGui::IsMouseClicked(0) && !ImGui::GetIO().WantCaptureMouse)
        take(session, stage, hover);
      if (held.kind != Kind::kNone) {
        if (ImGui::GetIO().MouseDown[0]) pull(session, stage);
        mine = true;
      }
    }
  }
  if (!ImGui::GetIO().MouseDown[0]) held = {};
  return mine;
}

bool isNear(const LightMark& mark, const ImVec2& at, float scale) {
  return std::hypot(mark.at.x - at.x, mark.at.y - at.y) < 10.0f * scale;
}

/// In the light's colour, with a dark rim that stands out from bright walls; brighter under the mouse.
void drawLightMarks(const Session& session, const Place& place, float scale) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  for (const LightMark& mark : lightMarks(session, place)) {
    const bool lit = !ImGui::GetIO().WantCaptureMouse && isNear(mark, mouse, scale);
    const ImU32 color = lit ? kBright : ImGui::GetColorU32({mark.color.x, mark.color.y, mark.color.z, 1.0f});
    list.AddCircleFilled(mark.at, 4.0f * scale, color);
    list.AddCircle(mark.at, 8.5f * scale, kRim, 24, 3.5f * scale);
    list.AddCircle(mark.at, 8.5f * scale, color, 24, 1.5f * scale);
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
  const bool selected = session.drawn() != nullptr && session.state.scene && session.selected_node != kNone;
  if (!selected) held = {};
  if (!selected && !ui.panel) return false;  // the picture alone
  ImGui::GetBackgroundDrawList()->PushClipRect(place.low,
                                               {place.low.x + place.size.x, place.low.y + place.size.y});
  drawLightMarks(session, place, ui.scale);
  const bool mine = selected && drawSelected(session, ui, place);
  ImGui::GetBackgroundDrawList()->PopClipRect();
  return mine;
}

}  // namespace gloam::view
