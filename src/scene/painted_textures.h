// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Textures painted by code.
#pragma once

#include <gloam/scene.h>

#include <functional>

namespace gloam {

/// A picture from a function over the unit square, v down; colour and alpha 0 to 1, as stored (sRGB or linear by its use).
Texture paint(const std::string& name, int width, int height,
              const std::function<glm::vec4(float u, float v)>& color);
/// A normal map of a height field that repeats, height in units of the texture's width (+X right, +Y up in the picture).
Texture paintNormals(const std::string& name, int width, int height,
                     const std::function<float(float u, float v)>& surface_height);

/// Noise that repeats after `period` cells in both directions, smooth, -1 to 1.
float tilingNoise(float x, float y, int period, std::uint32_t seed);
/// Value of a linear colour as an sRGB texture stores it.
glm::vec4 stored(const glm::vec3& linear, float alpha = 1.0f);
/// 0 below a, 1 above b, smooth between.
float smoothStep(float a, float b, float x);

}  // namespace gloam
