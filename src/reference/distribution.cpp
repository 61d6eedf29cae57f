// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "reference/distribution.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gloam::reference {

Distribution::Distribution(std::span<const float> weights, int bits) {
  const auto valid = [](float w) { return w > 0.0f && std::isfinite(w); };
  double total = 0.0;
  for (const float w : weights) total += valid(w) ? double(w) : 0.0;
  starts_.assign(weights.size(), 0);
  if (bits == 0) bits = std::clamp(int(std::bit_width(weights.size())) - 1, 1, 24);
  shift_ = 32 - bits;
  first_.resize(std::size_t(1) << bits);
  empty_ = !(total > 0.0);
  if (empty_) return;
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const bool chosen = valid(weights[i]);
    if (chosen) last_ = std::uint32_t(i);
    starts_[i] = std::uint32_t(std::min(sum / total * 0x1p32, 0x1p32 - 1.0));
    sum += chosen ? double(weights[i]) : 0.0;
  }
  std::uint32_t entry = 0;
  for (std::size_t part = 0; part < first_.size(); ++part) {
    while (entry < last_ && starts_[entry + 1] <= part << shift_) ++entry;
    first_[part] = entry;
  }
}

}  // namespace gloam::reference
