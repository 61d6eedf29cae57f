// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Handles of a thing or a light: arrows along the axes, squares for planes, a dot for the plane that faces the eye, rings to
// turn. What of them lies under the mouse and what a pull does; ui_gizmo.cpp draws them.
#pragma once

#include <array>
#include <optional>

#include "camera_control.h"
#include "node_moves.h"

namespace gloam::view {

inline constexpr int kRingPoints = 48;

/// Where handles stand. Places of the picture are in units of the window, from its upper left corner.
struct Handles {
  PosedCamera camera;
  glm::vec2 size{1.0f};  ///< of the picture
  glm::vec3 origin{0.0f};
  bool turns = false;  ///< rings instead of arrows
  float scale = 1.0f;  ///< of letters and panels

  float reach() const;  ///< of an arrow, in metres: as long on the screen wherever it stands
  glm::vec2 onScreen(const glm::vec3& world) const;
  glm::vec2 tip(int axis) const;
  std::array<glm::vec2, 4> square(int axis) const;
  std::array<glm::vec2, kRingPoints> ring(int axis) const;
};

/// One of them.
struct Handle {
  enum class Kind { kNone, kCentre, kAxis, kPlane, kRing };
  Kind kind = Kind::kNone;
  int axis = 0;
  explicit operator bool() const { return kind != Kind::kNone; }
};
Handle handleAt(const Handles& handles, const glm::vec2& mouse);

/// From the mouse's going down on a handle until it is let go.
class Pull {
 public:
  Pull(const Handles& handles, const Handle& handle, int node, cli::NodeMoves before, const glm::vec2& mouse);
  /// What is moved with the mouse at that place; nothing where the handle does not reach it.
  std::optional<cli::NodeMoves> to(const Scene& scene, const glm::vec2& mouse);
  const Handle& handle() const { return handle_; }
  const cli::NodeMoves& before() const { return before_; }
  glm::vec3 place() const { return handles_.origin + shift_; }  ///< of the handles now

 private:
  std::optional<glm::mat4> motionTo(const glm::vec2& mouse);

  Handles handles_;  ///< as they stood
  Handle handle_;
  int node_;
  cli::NodeMoves before_;
  glm::vec3 normal_, start_, shift_{0.0f};
  float start_value_ = 0.0f;  ///< metres along an axis, or an angle
};

}  // namespace gloam::view
