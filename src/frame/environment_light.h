// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/scene.h>
#include <gloam/sh.h>

#include "frame/frame_shared.h"
#include "gpu/image.h"

namespace gloam::frame {

/// How a light's ringing is damped before it is used (SH-9).
enum class Window : std::uint8_t { kNone, kHann, kLanczos, kAuto };
/// The light's first `order` bands, windowed: Hann and Lanczos over width order, kAuto as little as keeps it
/// non-negative.
sh::ShRgb windowed(const sh::ShRgb& light, int order, Window window);

/// Distant light on the device: its picture for the background and order-6 SH for the rest.
class EnvironmentLight {
 public:
  /// No light from afar.
  explicit EnvironmentLight(gpu::Device& device) : EnvironmentLight(device, Environment{}) {}
  /// Throws Error where the map is larger than an image of this device may be.
  EnvironmentLight(gpu::Device& device, const Environment& environment);

  /// Another number for every light that is made, of any device.
  std::uint64_t revision() const { return revision_; }
  bool empty() const { return row_.map_width == 0.0f; }
  /// Radiance, order 6, as projected: rotation and intensity are applied, no window.
  const sh::ShRgb& sh() const { return sh_; }
  const EnvironmentRow& row() const { return row_; }
  /// Equirectangular, half floats, with mips. Radiance beyond 65504 is clipped there (in sh() it is not).
  const gpu::Image& map() const { return map_; }
  /// Light through unshadowed Phong lobes by mirror direction and exponent (frame/gloss.glsl reads it), from
  /// sh(), damped as little as keeps what the sharpest lobe shows non-negative.
  const gpu::Image& gloss() const { return gloss_; }

 private:
  std::uint64_t revision_ = 0;
  sh::ShRgb sh_;
  EnvironmentRow row_{};
  gpu::Image map_, gloss_;
};

}  // namespace gloam::frame
