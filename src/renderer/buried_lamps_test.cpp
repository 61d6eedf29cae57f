// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/renderer.h>
#include <gtest/gtest.h>

namespace gloam {
namespace {

TEST(BuriedLamps, AreToldUnlessTheEyeIsThereToo) {
  const Scene scene = loadScene("builtin:balls?count=1");
  PosedScene posed = pose(scene, 0.0f);
  const glm::vec3 middle(posed.instances.at(1).world_from_object[3]),
      outside = middle + glm::vec3(0.0f, 50.0f, 0.0f);
  posed.lights.clear();
  PosedLight& lamp = posed.lights.emplace_back();
  lamp.light.name = "bulb";
  lamp.position = middle;
  ASSERT_EQ(buriedLamps(scene, posed, outside).size(), 1u);
  EXPECT_NE(buriedLamps(scene, posed, outside)[0].find("lamp 'bulb' is inside"), std::string::npos);
  EXPECT_TRUE(buriedLamps(scene, posed, middle).empty());
  lamp.position = outside;
  EXPECT_TRUE(buriedLamps(scene, posed, outside).empty());
  lamp.position = middle;
  lamp.light.type = Light::Type::kDirectional;
  EXPECT_TRUE(buriedLamps(scene, posed, outside).empty());
}

/// Rooms that hold lamp and eye, shades, bulbs beside their lamps.
TEST(BuriedLamps, OfSuchScenesNoneIs) {
  for (const char* name : {"builtin:cornell", "builtin:lamp", "builtin:conference", "builtin:swing",
                           "builtin:clutter?detail=0.3", "builtin:teapot"}) {
    const Scene scene = loadScene(name);
    const PosedScene posed = pose(scene, 0.0f);
    const glm::vec3 eye(posed.cameras.at(0).world_from_view[3]);
    for (const std::string& line : buriedLamps(scene, posed, eye)) ADD_FAILURE() << name << ": " << line;
  }
}

}  // namespace
}  // namespace gloam
