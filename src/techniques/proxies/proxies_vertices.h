// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The technique's own passes over the vertices of a scene instead of the receivers of a picture, as programs before it did
// (Sloan et al. 2007, figure 6): for measuring, and for whoever keeps light a vertex.
#pragma once

#include <gloam/renderer.h>

#include <memory>
#include <span>

#include "frame/proxy.h"

namespace gloam::proxies {

class VertexShading {
 public:
  /// `device` as Renderer takes it. Throws Error.
  VertexShading(const std::string& device, const Scene& scene, const PosedScene& posed,
                const Environment& environment, std::span<const frame::Proxy> proxies);
  ~VertexShading();
  VertexShading(const VertexShading&) = delete;
  VertexShading& operator=(const VertexShading&) = delete;

  std::size_t vertexCount() const;
  /// Computes the light of all vertices once; each pass with its time. `settings` are the technique's; divisor and upsample
  /// have no effect.
  std::vector<PassTime> shade(const Settings& settings);
  /// Direct irradiance of each vertex, in the order of instances and their vertices, as the last shade() found it.
  std::vector<glm::vec3> direct() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gloam::proxies
