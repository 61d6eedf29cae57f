// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "frame/receivers.h"

#include <fmt/format.h>

#include "shaders/frame_shaders.h"

namespace gloam::frame {

const ReceiverLevel& Receivers::at(int divisor) {
  if (divisor != 1 && divisor != 2 && divisor != 4 && divisor != 8)
    throw Error("receivers", fmt::format("1/{} of the size; 1, 1/2, 1/4 and 1/8 exist", divisor));
  const auto [place, is_new] = levels_.try_emplace(divisor);
  ReceiverLevel& level = place->second;
  if (!is_new) return level;
  level.divisor = divisor;
  level.width = (gbuffer_.width + divisor - 1) / divisor;
  level.height = (gbuffer_.height + divisor - 1) / divisor;
  const std::string suffix = fmt::format("_{}", divisor);
  const gpu::ImageDesc desc{
      .format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = level.width, .height = level.height};
  level.position = graph_.create("frame.receiver_position" + suffix, desc);
  level.normal_depth = graph_.create("frame.receiver_normal" + suffix, desc);
  graph_.compute("frame.receivers" + suffix, frame_receivers_spv)
      .read("frame_view", view_)
      .read("depth", gbuffer_.depth)
      .read("normals", gbuffer_.normals)
      .write("receiver_position", level.position)
      .write("receiver_normal", level.normal_depth)
      .push(static_cast<std::uint32_t>(divisor))
      .dispatchOver(level.position);
  return level;
}

}  // namespace gloam::frame
