// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/radiance_filter/radiance_filter.h"

#include "frame/test_frame.h"

namespace gloam::radiance_filter {
namespace {

TEST(RadianceFilterTwin, Draws) {
  frame::TestFrame frame(loadScene("builtin:furnace"));
}

}  // namespace
}  // namespace gloam::radiance_filter
