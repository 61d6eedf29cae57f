// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// OpenVDB files. The library is asked for where it is installed; its grids are sparse and of any extent, ours are dense.
#include <fmt/format.h>

#include "image/limits.h"
#include "scene/volume_files.h"

#if GLOAM_HAS_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#endif

namespace gloam {

#if GLOAM_HAS_OPENVDB

namespace {

std::string namesIn(openvdb::io::File& file) {
  std::string names;
  for (auto name = file.beginName(); name != file.endName(); ++name)
    names += (names.empty() ? "" : ", ") + name.gridName();
  return names;
}

openvdb::FloatGrid::Ptr openGrid(openvdb::io::File& file, const std::string& path,
                                 const std::string& wanted) {
  std::string name = wanted;
  if (name.empty() && file.hasGrid("density")) name = "density";
  if (name.empty() && file.beginName() != file.endName()) name = file.beginName().gridName();
  if (name.empty()) throw Error(path, "holds no grid");
  if (!file.hasGrid(name))
    throw Error(path, fmt::format("grid: '{}' is not in the file; there are {}", oneLine(name),
                                  oneLine(namesIn(file))));
  const openvdb::GridBase::Ptr any = file.readGridMetadata(name);
  if (!any || !any->isType<openvdb::FloatGrid>())
    throw Error(path, fmt::format("grid: '{}' is not of 32-bit floats", oneLine(name)));
  return openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
}

Volume resampled(const openvdb::FloatGrid& grid, const std::string& path, int cells) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) throw Error(path, "the grid holds no voxels");
  const openvdb::Coord extent = box.dim();
  const double longest = std::max({extent.x(), extent.y(), extent.z()});
  const double step = std::max(1.0, longest / double(cells));  // voxels of the file to one of ours
  Volume volume;
  glm::dvec3 first(0.0);
  for (int c = 0; c < 3; ++c) {
    volume.size[c] = std::clamp(int(std::ceil(double(extent[c]) / step - 1e-6)), 2, cells);
    first[c] = double(box.min()[c]) - 0.5;
    volume.bounds_max[c] = float(double(volume.size[c]) * step * grid.voxelSize()[c]);
  }
  volume.density.resize(volume.voxels());
  const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
  std::size_t at = 0;
  for (int z = 0; z < volume.size.z; ++z)
    for (int y = 0; y < volume.size.y; ++y)
      for (int x = 0; x < volume.size.x; ++x, ++at) {
        const openvdb::Vec3d place(first.x + (x + 0.5) * step, first.y + (y + 0.5) * step,
                                   first.z + (z + 0.5) * step);
        volume.density[at] = std::max(0.0f, openvdb::tools::BoxSampler::sample(accessor, place));
      }
  return volume;
}

}  // namespace

Volume readVdb(const std::string& path, const std::string& grid, int cells) {
  std::uint64_t bytes = 0;
  openForReading(path, &bytes);  // says what is wrong with a missing file
  try {
    openvdb::initialize();
    openvdb::io::File file(path);
    file.open(false);
    return resampled(*openGrid(file, path, grid), path, cells);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(path, oneLine(error.what()));
  }
}

#else

Volume readVdb(const std::string& path, const std::string&, int) {
  throw Error(path, "this gloam was built without OpenVDB (Debian: libopenvdb-dev); .raw grids are read");
}

#endif

}  // namespace gloam
