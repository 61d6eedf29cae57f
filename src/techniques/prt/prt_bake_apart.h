// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Objects of a scene that are baked apart, so that they may move against one another (PRT-5).
#pragma once

#include <gloam/bake.h>

#include <functional>
#include <vector>

namespace gloam::prt {

/// By node: the number of the object that it belongs to, from 0 on; kNone for nodes of objects without rigid triangles.
/// Objects are the scene's roots, in their order; a root that stands alone without meshes gives way to its children.
std::vector<int> objectsOfNodes(const Scene& scene, const PosedScene& posed);

/// Bakes one scene as one object.
using BakeOne = std::function<Scene(const Scene&, const BakeOptions&, const Progress&, BakeReport&)>;

/// Each object by itself, one after the other; checkpoints stand beside options.checkpoint, one an object, until all are
/// done. `scene` has unique instances. Throws as `bake` does.
Scene bakeApart(Scene scene, const BakeOptions& options, const Progress& progress, BakeReport& report,
                const BakeOne& bake);

}  // namespace gloam::prt
