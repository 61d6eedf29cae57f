// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a technique is. To add one called NAME:
//  1. copy irradiance/ to NAME/ and rename: folder, namespace, class, shader files and pass names all say NAME;
//  2. in NAME/NAME.h declare its class and its TechniqueInfo (summary, coverage, options: declared once, they become
//     command-line flags, sliders and docs);
//  3. record() adds passes "NAME.verb" to the graph and returns irradiance, direct and indirect apart, at any of the
//     receivers' sizes (frame/frame_inputs.h); frame/ makes colour of it;
//  4. add one line to the table in registry.cpp and one to CMakeLists.txt here;
//  5. NAME_test.cpp: a law (furnace), a slow twin, bad input, a golden picture; README.md: paper, equations, cost, limits.
#pragma once

#include <gloam/renderer.h>

#include <memory>

#include "frame/frame_inputs.h"

namespace gloam {

/// A way of lighting a frame. One object lives as long as its renderer and keeps what it needs from frame to
/// frame.
class Technique {
 public:
  virtual ~Technique() = default;
  /// Adds this technique's passes; returns irradiance, direct and indirect apart (frame/frame_inputs.h). Throws
  /// Error where it cannot light this scene. `settings` holds its options.
  virtual frame::Lighting record(gpu::FrameGraph& graph, const frame::FrameInputs& inputs,
                                 const Settings& settings) = 0;
};

/// The technique of that name from the one table (registry.cpp). Throws Error that lists the names.
std::unique_ptr<Technique> makeTechnique(const std::string& name, gpu::Device& device);

}  // namespace gloam
