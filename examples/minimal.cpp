// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Loads a scene, draws it under a sky, writes a picture.
//   minimal [SCENE [SKY [PICTURE.png]]]
#include <gloam/renderer.h>

#include <cstdio>
#include <string>

int main(int argc, char** argv) try {
  const std::string file = argc > 1 ? argv[1] : "builtin:cornell";
  const std::string sky = argc > 2 ? argv[2] : "sky:mild";
  const std::string picture = argc > 3 ? argv[3] : "minimal.png";

  const gloam::Scene scene = gloam::loadScene(file);
  const gloam::PosedScene posed = gloam::pose(scene, 0.0f);
  const gloam::PosedCamera camera =
      posed.cameras.empty() ? gloam::framingCamera(posed, 4.0f / 3.0f) : posed.cameras.front();

  gloam::Renderer renderer;  // the best device here, a GPU or the software driver
  renderer.setScene(scene);
  renderer.setEnvironment(gloam::loadEnvironment(sky));

  gloam::RenderOptions options;
  options.width = 640;
  options.height = 480;
  options.technique = "irradiance";
  const gloam::RenderedFrame frame = renderer.render(posed, camera, options);

  gloam::writePng(gloam::toDisplay(frame.layers, {.exposure_stops = 0.0f}), picture);
  std::printf("%s: %s by %s\n", picture.c_str(), file.c_str(), renderer.device().name.c_str());
  return 0;
} catch (const gloam::Error& error) {
  std::fprintf(stderr, "minimal: %s\n", error.what());
  return 2;
}
