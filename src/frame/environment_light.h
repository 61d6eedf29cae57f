// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <gloam/scene.h>
#include <gloam/sh.h>

#include "frame/environment_picture.h"

namespace gloam::frame {

/// How a light's ringing is damped before it is used (SH-9).
enum class Window : std::uint8_t { kNone, kHann, kLanczos, kAuto };
/// Of the options' words: hann, lanczos, auto; kNone for any other.
Window windowNamed(const std::string& name);
/// The light's first `order` bands, windowed: Hann and Lanczos over width order, kAuto as little as keeps it
/// non-negative.
sh::ShRgb windowed(const sh::ShRgb& light, int order, Window window);

/// Distant light on the device: order-6 SH for what is lit, tables and pictures made when they are first looked at.
class EnvironmentLight {
 public:
  /// No light from afar.
  explicit EnvironmentLight(gpu::Device& device) : EnvironmentLight(device, Environment{}) {}
  /// Throws Error where the map is larger than an image of this device may be.
  EnvironmentLight(gpu::Device& device, const Environment& environment);
  /// Another light, with as much of what is on the device as it shares with the last.
  void set(const Environment& environment);

  /// Another number for every light that is set, of any device.
  std::uint64_t revision() const { return revision_; }
  bool empty() const { return picture_.empty(); }
  /// Radiance, order 6, as projected: rotation and intensity are applied, no window.
  const sh::ShRgb& sh() const { return sh_; }
  const EnvironmentPicture& picture() const { return picture_; }
  /// Light through unshadowed Phong lobes by mirror direction and exponent (frame/gloss.glsl reads it), from
  /// sh(), damped as little as keeps what the sharpest lobe shows non-negative.
  const gpu::Image& gloss() const;
  /// Any image that may stand in its place where it is not looked up.
  const gpu::Image& anyGloss() const { return gloss_; }

 private:
  std::uint64_t revision_ = 0;
  sh::ShRgb sh_;
  EnvironmentPicture picture_;
  mutable std::uint64_t gloss_revision_ = 0;
  mutable gpu::Image gloss_;
};

}  // namespace gloam::frame
