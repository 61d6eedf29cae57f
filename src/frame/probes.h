// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The radiance that arrives at points of the scene, sampled every frame on the device: a small cube picture of all but what
// is left out, projected to spherical harmonics by the solid angles of its texels (SH-2); lamps, which no picture shows,
// are added as directions. Rows PRT-5, SH-2.
#pragma once

#include <array>
#include <map>

#include "frame/frame_inputs.h"
#include "frame/probe_shared.h"

namespace gloam::frame {

/// Where a cube picture is taken.
struct ProbePlace {
  glm::vec3 position{0.0f};
  float z_near = 1e-3f;     ///< what is nearer is not seen
  std::uint32_t group = 0;  ///< instances of this group are left out
};

/// A group that no place leaves out.
inline constexpr std::uint32_t kNoGroup = 0xffffffffu;

/// What a technique found at the vertices of surfaces, for probes to see.
struct LitSurfaces {
  gpu::BufferRef rows;    ///< LitRow, by instance
  gpu::BufferRef vertex;  ///< SurfaceLight
};

/// Whoever receives a probe's light: which one, and a rotation (or reflection) to the receiver's axes.
struct ProbeReceiver {
  std::uint32_t probe = 0;
  glm::mat3 axes_from_world{1.0f};
};

/// Lasts from frame to frame: the projection's table and the sky's picture.
class ProbeTables {
 public:
  explicit ProbeTables(gpu::Device& device) : device_(device) {}
  /// [texel][kProbeStride]; texels by face, row, column. Integrals over texels, by 4 x 4 points each; solid angles are exact.
  const gpu::Buffer& projection(int size);
  struct Sky {
    gpu::Buffer texels;  ///< mean radiance, [face][row][column]
    gpu::Buffer row;     ///< ProbeSky
  };
  const Sky& sky(const EnvironmentLight& environment, int size);

 private:
  gpu::Device& device_;
  std::map<int, gpu::Buffer> projections_;
  Sky sky_;
  std::uint64_t sky_revision_ = 0;
  int sky_size_ = 0;
};

struct ProbeOptions {
  int size = 16;                                           ///< texels a side of a face, 4 to 128
  int order = 5;                                           ///< bands of their light, 1 to 6
  std::array<float, 6> band_factors = {1, 1, 1, 1, 1, 1};  ///< of a window
};

/// The probes of one frame. Pictures are called NAME_emitted and NAME_reflected: a row is a probe, its columns are faces
/// +X -X +Y -Y +Z -Z as sh::cubeDirection has them.
class Probes {
 public:
  /// Adds raster passes "NAME": the G-buffer of all cubes. `groups`: by instance. Throws Error where the pictures are larger
  /// than an image of this device.
  Probes(gpu::FrameGraph& graph, const FrameInputs& inputs, ProbeTables& tables, const std::string& name,
         std::vector<ProbePlace> places, std::span<const std::uint32_t> groups, const ProbeOptions& options);

  /// Most probes that fit into one image of this device.
  static std::size_t most(const gpu::Device& device, int size);

  /// Whom to light; before gather().
  void setReceivers(std::span<const ProbeReceiver> receivers);
  /// Adds "NAME_light", "NAME_project" and "NAME_gather": what probes see, with surfaces lit as told. `lamps_on_lit`: the
  /// light of LitSurfaces does not hold that of lamps, which is added. Surfaces without light are lit by `unlit`, irradiance in
  /// SH of order 6. May be called again with other light.
  void gather(const LitSurfaces& lit, bool lamps_on_lit, const sh::ShRgb& unlit);

  gpu::BufferRef lights() const { return lights_; }  ///< ProbeLight, [receiver][coefficient]: all but lamps
  gpu::BufferRef lampLights() const { return lamp_lights_; }  ///< vec3, [receiver][coefficient]: lamps alone
  gpu::BufferRef lampsSeen() const {
    return lamps_seen_;
  }  ///< floats, [probe][lamp]: 0 where something stands before it
  gpu::BufferRef trust() const { return trust_; }  ///< floats, [probe]: 0 where it is buried in something
  const std::vector<ProbePlace>& places() const { return places_; }

 private:
  void drawFace(std::size_t probe, int face, const FrameView& view, std::span<const std::uint32_t> groups);
  std::vector<ProbeLamp> lampRows() const;

  gpu::FrameGraph& graph_;
  const FrameInputs& inputs_;
  ProbeTables& tables_;
  std::string name_;
  std::vector<ProbePlace> places_;
  ProbeOptions options_;
  gpu::BufferRef views_, jobs_, turns_, lamps_, sums_, lights_, lamp_lights_, lamps_seen_, trust_;
  std::uint32_t receiver_count_ = 0;
  gpu::ImageRef depth_, ids_, normals_, diffuse_, specular_, emission_, emitted_, reflected_;
};

}  // namespace gloam::frame
