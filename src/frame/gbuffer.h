// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the rasteriser finds out about each pixel, once, for all that follows (frame/gbuffer.glsl reads it).
#pragma once

#include "frame/gpu_scene.h"

namespace gloam::frame {

/// Images of the size of the rendering. Names in the graph: frame.ids, frame.normals_packed …
struct GBuffer {
  int width = 0, height = 0;
  int supersample = 1;  ///< samples a side that make a pixel of the picture
  gpu::ImageRef depth;  ///< D32, reversed; 0 is background
  gpu::ImageRef
      ids;  ///< two uint32: object id (1 + index of the instance, 0: background), triangle of its mesh
  gpu::ImageRef normals;   ///< two uint32: shading and geometric normal, octahedral; both on the eye's side
  gpu::ImageRef diffuse;   ///< k_d, and roughness in A; halves
  gpu::ImageRef specular;  ///< k_s; halves
  gpu::ImageRef emission;  ///< radiance; halves
};

/// Bytes a pixel that it takes.
inline constexpr int kGBufferBytes = 4 + 8 + 8 + 8 + 8 + 8;

/// Adds the raster pass "frame.gbuffer", unless what was drawn with the same `key` (standing.h) still stands. `view` is the
/// buffer of the frame's FrameView, `width` and `height` are the picture's.
GBuffer recordGBuffer(gpu::FrameGraph& graph, const GpuScene& scene, gpu::BufferRef view, int width,
                      int height, int supersample, const std::string& key);

/// Draws instances at places first_place … of the order of drawing, in a pass of the G-buffer's shaders.
void drawSurface(gpu::RasterPass& pass, const GpuScene& scene, std::uint32_t mesh, std::uint32_t first_place,
                 std::uint32_t count);

/// Adds "frame.motion": how far each pixel's surface point has moved since the last pose and camera, in
/// pixels, in RG of a half-float image (0 for background, which moves with the camera alone and is left out).
gpu::ImageRef recordMotion(gpu::FrameGraph& graph, const GpuScene& scene, const GBuffer& gbuffer,
                           gpu::BufferRef view);

}  // namespace gloam::frame
