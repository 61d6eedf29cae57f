// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Puts a scene together by hand.
#pragma once

#include <gloam/scene.h>

#include <string>
#include <vector>

#include "scene/named_values.h"

namespace gloam {

class SceneBuilder {
 public:
  explicit SceneBuilder(std::string name) { scene_.name = std::move(name); }

  // Materials; colours are linear. Each returns an index.
  int diffuse(const std::string& name, const glm::vec3& albedo);  ///< no specular lobe at all
  int glossy(const std::string& name, const glm::vec3& albedo, float roughness);
  int metal(const std::string& name, const glm::vec3& color, float roughness);
  Material& material(int index) { return scene_.materials[std::size_t(index)]; }
  int texture(Texture texture);

  int mesh(const std::string& name, Mesh mesh, int material);
  int node(const std::string& name, int parent = kNone, const glm::vec3& translation = glm::vec3(0.0f));
  Node& at(int node) { return scene_.nodes[std::size_t(node)]; }
  /// A mesh on a node of its own; returns the node.
  int place(const std::string& name, Mesh mesh, int material, const glm::vec3& translation = glm::vec3(0.0f),
            int parent = kNone);

  void camera(const glm::vec3& eye, const glm::vec3& target, float vertical_fov_deg);
  /// Lights shine along `direction`; a point light ignores it. Returns the node.
  int light(const Light& light, const glm::vec3& position, const glm::vec3& direction = {0.0f, -1.0f, 0.0f},
            int parent = kNone);
  void sky(const std::string& description);

  /// One animation holds all channels.
  AnimationChannel& channel(int node, AnimationChannel::Path path,
                            AnimationChannel::Interpolation interpolation);
  int skin(std::vector<int> joints, std::vector<glm::mat4> joint_from_mesh);

  Scene finish();
  const Scene& scene() const { return scene_; }

 private:
  Scene scene_;
};

/// Rotation that brings -Z to `direction`, with +Y as nearly up as it can be.
glm::quat lookingAlong(const glm::vec3& direction);
/// Rotation and keys as channels store them.
void addKey(AnimationChannel& channel, float time_s, const glm::vec3& value);
void addKey(AnimationChannel& channel, float time_s, const glm::quat& value);

/// Vertices along a side at a given detail.
struct Detail {
  float factor = 1.0f;
  int operator()(int cells) const { return std::max(1, int(float(cells) * factor + 0.5f)); }
  float cell(float size) const { return size / factor; }
};

// The scenes, each in the file that its comment names.
Scene makeFurnace(const Detail& detail, NamedValues& values);         // builtin_furnaces.cpp
Scene makeConcaveFurnace(const Detail& detail, NamedValues& values);  //
Scene makeBowl(const Detail& detail, NamedValues& values);            //
Scene makeCornell(const Detail& detail, NamedValues& values);         // builtin_rooms.cpp
Scene makeLamp(const Detail& detail, NamedValues& values);            //
Scene makeSpheres(const Detail& detail, NamedValues& values);         // builtin_stages.cpp
Scene makeShadow(const Detail& detail, NamedValues& values);          //
Scene makeBronze(const Detail& detail, NamedValues& values);          //
Scene makeCaustic(const Detail& detail, NamedValues& values);         //
Scene makeMobile(const Detail& detail, NamedValues& values);          //
Scene makeColumns(const Detail& detail, NamedValues& values);         // builtin_columns.cpp
Scene makeGallery(const Detail& detail, NamedValues& values);         // builtin_gallery.cpp
Scene makeLanterns(const Detail& detail, NamedValues& values);        // builtin_lanterns.cpp
Scene makeSwing(const Detail& detail, NamedValues& values);           // builtin_swing.cpp
Scene makeTextured(const Detail& detail, NamedValues& values);        // builtin_textured.cpp
Scene makeCloud(const Detail& detail, NamedValues& values);           // builtin_cloud.cpp
Scene makePassing(const Detail& detail, NamedValues& values);         // builtin_neighbours.cpp
Scene makeRing(const Detail& detail, NamedValues& values);            //
Scene makeSquirrel(const Detail& detail, NamedValues& values);        // builtin_squirrel.cpp
Scene makeRobot(const Detail& detail, NamedValues& values);           // builtin_robot.cpp
Scene makePackages(const Detail& detail, NamedValues& values);        // builtin_packages.cpp
Scene makeAssembly(const Detail& detail, NamedValues& values);        // builtin_assembly.cpp
Scene makeBalls(const Detail& detail, NamedValues& values);           // builtin_trials.cpp
Scene makePair(const Detail& detail, NamedValues& values);            //
Scene makeBend(const Detail& detail, NamedValues& values);            //
Scene makeBox(const Detail& detail, NamedValues& values);             //
Scene makeLinks(const Detail& detail, NamedValues& values);           //
Scene makeBars(const Detail& detail, NamedValues& values);            //
Scene makeFurnacePair(const Detail& detail, NamedValues& values);     //
Scene makeBumps(const Detail& detail, NamedValues& values);           // builtin_filtered.cpp
Scene makeConference(const Detail& detail, NamedValues& values);      //
Scene makeVehicle(const Detail& detail, NamedValues& values);         // builtin_vehicle.cpp
Scene makeWetFloor(const Detail& detail, NamedValues& values);        //
Scene makeWalker(const Detail& detail, NamedValues& values);          // builtin_walker.cpp

}  // namespace gloam
