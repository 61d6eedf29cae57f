// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What is seen of distant light: a map, and discs before it. Lights that are described (gloam/lights.h) are painted where they
// are looked at, and only what cannot be told from the last ones is painted again.
#pragma once

#include <gloam/lights.h>

#include "frame/frame_shared.h"
#include "gpu/image.h"

namespace gloam::frame {

class EnvironmentPicture {
 public:
  explicit EnvironmentPicture(gpu::Device& device);

  /// Texels are uploaded at once; of described lights nothing is. Throws Error where a map is larger than an image of this
  /// device may be.
  void set(const Environment& environment);
  bool empty() const { return empty_; }
  /// What map() needs to be looked up.
  const EnvironmentRow& row() const { return row_; }
  /// In front of the map; radiance and direction are the world's.
  const std::vector<DiscRow>& discs() const { return discs_; }
  /// Equirectangular, half floats, with mips; without the discs. Made now where it was not. Radiance beyond 65504 is clipped.
  const gpu::Image& map() const;
  /// Any image that may stand in its place where it is not looked up.
  const gpu::Image& anyMap() const { return map_; }

 private:
  void describe(const Environment& environment);
  void upload(const Environment& environment) const;

  gpu::Device* device_;
  bool empty_ = true;
  EnvironmentRow row_{};
  std::vector<DiscRow> discs_;
  std::vector<DistantLight> behind_;  ///< of which map_ is, or is to be
  mutable bool painted_ = true;
  mutable gpu::Image map_;
};

}  // namespace gloam::frame
