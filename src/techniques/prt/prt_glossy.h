// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Run time of glossy transfer (PRT-2, PRT-8): the gloss of the environment, self-shadowed and self-reflected.
#pragma once

#include "techniques/prt/prt_glossy_transfer.h"

namespace gloam::prt {

/// Light of probes in place of the world's (LocalLight).
struct LocalGloss {
  gpu::BufferRef lights, lamp_lights, places, trust;  ///< as LocalLight has them
  gpu::BufferRef rows;                                ///< LocalRow, of each instance that `glossy` lights
  bool lamps = false;                                 ///< lamps too shine through the matrices
  int points = 0, order = 0;  ///< an object; bands of `lights`, no fewer than `glossy` takes
};

/// Radiance at vertices as the host left it, kept while light and objects stand. It belongs to one GlossyBuffers.
struct GlossFields {
  gpu::Buffer buffer;
  std::vector<glm::vec3> light;  ///< GlossyBuffers::lightRows() that it is of
};

/// Adds "prt.gloss_vertices", once a chunk (where the host multiplies: once, and not while `kept` holds), and "prt.gloss_pixels". `light` is the world's, with as many bands as are to be
/// used; `damped`: where ringing makes a lobe negative, a blunter one is mixed in. With `local` the pass is "prt.local_gloss". The images hold what the unit-integral lobe of each pixel gathers: k_s is not applied.
std::vector<frame::Gloss> recordGloss(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                      const GlossyBuffers& glossy, const sh::ShRgb& light, bool damped,
                                      bool indirect, GlossFields& kept, const LocalGloss* local = nullptr);

}  // namespace gloam::prt
