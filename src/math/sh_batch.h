// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What the SIMD kernels share. A kernel wants at least one full vector; shorter batches go through padded copies.
#pragma once

#include <gloam/sh.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace gloam::sh {

/// Lanes of the widest instruction set that the kernels are compiled for.
inline constexpr std::size_t kMaxLanes = 16;

/// Name of the instruction set that batches run on here ("AVX3": Highway's word for AVX-512).
std::string simdTarget();

/// Throws Error unless a span of `given` floats holds `planes` planes of `count` at that stride.
void checkPlanes(const char* what, std::size_t given, int planes, std::size_t count, std::size_t stride);

/// A batch of fewer items than lanes.
struct PaddedPlanes {
  std::array<float, kMaxLanes * kMaxCoefficients> in{}, out{};

  PaddedPlanes() = default;
  PaddedPlanes(std::span<const float> from, int planes, std::size_t count, std::size_t stride) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(planes); ++i)
      std::copy_n(from.data() + i * stride, count, in.data() + i * kMaxLanes);
  }
  void copyOut(std::span<float> to, int planes, std::size_t count, std::size_t stride) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(planes); ++i)
      std::copy_n(out.data() + i * kMaxLanes, count, to.data() + i * stride);
  }
};

}  // namespace gloam::sh
