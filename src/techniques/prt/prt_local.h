// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Local light (PRT-5): the radiance around each object is sampled every frame and multiplies its transfer in place of
// distant light. README.md has the rest.
#pragma once

#include <optional>

#include "frame/probes.h"
#include "techniques/prt/prt_local_points.h"
#include "techniques/prt/prt_local_shared.h"
#include "techniques/prt/prt_transfer.h"

namespace gloam::prt {

struct LocalOptions {
  bool lamps = false;  ///< lamps too shine through transfer; else their direct light is left to frame/
  int size = 16;       ///< texels a side of a cube's face
  int bounces = 1;     ///< between objects
  bool damped = true;  ///< window where ringing shows
  frame::Window window = frame::Window::kNone;  ///< of all light
};

/// What was baked together and moves together.
struct LocalObject {
  std::uint32_t anchor = 0;  ///< the instance in whose axes `points` stand
  std::vector<glm::vec3> points;
  float extent = 0.0f;  ///< diagonal of its box in the anchor's axes
};

class LocalLight {
 public:
  /// For the instances of this layout. Copies of one baked mesh are objects of their own.
  LocalLight(const frame::GpuScene& scene, const TransferBuffers& transfer, int points);

  const std::vector<LocalObject>& objects() const { return objects_; }
  int points() const { return points_; }

  /// Adds "prt.local_cube…" and "prt.local_vertices"; every vertex's irradiance (VertexLight). May be called once a frame.
  gpu::BufferRef record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                        const TransferBuffers& transfer, frame::ProbeTables& tables,
                        const LocalOptions& options);

  // Of the last record():
  gpu::BufferRef lights() const { return lights_; }  ///< frame::ProbeLight, [job][coefficient of `order`]
  gpu::BufferRef lampLights() const { return lamp_lights_; }  ///< as frame::Probes has it
  /// Of the instances whose vertices' radiance begins at `first_outputs` (by instance; kUnbaked: none).
  std::vector<LocalRow> rowsOf(const frame::GpuScene& scene, const TransferBuffers& transfer,
                               std::span<const std::uint32_t> first_outputs) const;
  gpu::BufferRef places() const { return places_; }  ///< of probes, in the world
  gpu::BufferRef trust() const { return trust_; }

 private:
  void findObjects(const frame::GpuScene& scene, const TransferBuffers& transfer);
  void pick(const frame::GpuScene& scene, const TransferBuffers& transfer);
  std::vector<frame::ProbePlace> placesNow(const frame::GpuScene& scene) const;
  std::vector<LocalRow> rowsNow(const frame::GpuScene& scene, const TransferBuffers& transfer,
                                std::vector<frame::ProbeReceiver>& receivers) const;
  void lightVertices(gpu::FrameGraph& graph, const frame::GpuScene& scene, const frame::ShadowMaps& lamps,
                     const TransferBuffers& transfer, const LocalOptions& options,
                     gpu::BufferRef output) const;

  int points_;
  std::vector<LocalObject> objects_;
  std::vector<std::uint32_t> object_of_lit_;  ///< by lit instance
  std::vector<LocalRow> lit_rows_;            ///< by lit instance, of the last record()
  std::vector<std::uint32_t> groups_;         ///< by instance: its object, or frame::kNoGroup
  gpu::BufferRef lights_, lamp_lights_, lamps_seen_, rows_, places_, trust_;
};

}  // namespace gloam::prt
