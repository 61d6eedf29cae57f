// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Volumes from files (docs/scene-files.md, "Volumes"): bare grids, and OpenVDB where gloam was built with it.
#pragma once

#include <gloam/volume.h>

#include <map>
#include <string>

namespace gloam {

/// "cloud.raw?size=64x64x64&type=u8": a path, and values by name behind a question mark.
struct VolumeFile {
  std::string path;
  std::map<std::string, std::string> values;
};

/// Whether the name, without its values, ends in .raw or .vdb.
bool namesVolumeFile(const std::string& name);

/// A scene with the volume of that name above a floor. Throws Error that names the file and the value.
Scene readVolumeScene(const std::string& name, const Progress& progress = {});

/// The .vdb's float grid, resampled to `cells` voxels along its longest side; extinction as the file has it, in a box of the
/// file's own units. Throws Error, also where gloam was built without OpenVDB.
Volume readVdb(const std::string& path, const std::string& grid, int cells);

/// A floor with the volume above it, a camera and a sky: what a file of nothing but density needs to be seen. The volume is
/// centred, `above` metres over the floor. `cell` is the length of the floor's triangles.
Scene volumeScene(const std::string& name, Volume volume, float above, float cell);

}  // namespace gloam
