// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Patterns of strong colour: what bounces off them differs from place to place.
#pragma once

#include <gloam/scene.h>

#include <functional>
#include <string>

#include "scene/scene_builder.h"

namespace gloam {

/// A diffuse material whose linear albedo is a function of the UVs, each 0 to 1; it repeats.
int addPainted(SceneBuilder& builder, const std::string& name,
               const std::function<glm::vec3(float u, float v)>& albedo, int width = 256, int height = 256);

/// Square tiles of two tones with joints between, 4 by 4 in a picture.
int addTiles(SceneBuilder& builder, const std::string& name, const glm::vec3& light, const glm::vec3& dark);
/// Boards along v, four beside each other, with grain.
int addBoards(SceneBuilder& builder, const std::string& name, const glm::vec3& wood);
/// Plaster of slightly uneven tone, with a band of another colour between two heights (v).
int addPlaster(SceneBuilder& builder, const std::string& name, const glm::vec3& tone, const glm::vec3& band,
               float band_from, float band_to);
/// For spheres by longitude and latitude: gores of two colours in turn, a disc at each pole.
int addGores(SceneBuilder& builder, const std::string& name, const glm::vec3& a, const glm::vec3& b,
             const glm::vec3& pole, int gores);
/// The same with belts round the equator.
int addBelts(SceneBuilder& builder, const std::string& name, const glm::vec3& ground, const glm::vec3& belt,
             int belts);
/// Chequers, nu by nv.
int addChequers(SceneBuilder& builder, const std::string& name, const glm::vec3& a, const glm::vec3& b,
                int nu, int nv);

}  // namespace gloam
