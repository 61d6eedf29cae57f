// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam scene: writes a scene that is made by code, or any that can be read, as .glb; with spheres in place of its models where
// that is asked for.
#include <fmt/core.h>
#include <gloam/scene.h>
#include <image/atomic_file.h>
#include <renderer/spheres_scene.h>

#include "json.h"
#include "output.h"
#include "scene_inputs.h"
#include "spheres_run.h"
#include "verb.h"

namespace gloam::cli {
namespace {

struct WriteChoice {
  SceneChoice scene;
  std::string output;
  bool as_spheres = false;
  int spheres = 0;  ///< 0: by size and shape
  float time_s = 0.0f;
};

int runScene(WriteChoice choice, Console& console) {
  const std::string bare = choice.scene.name.substr(0, choice.scene.name.find('?'));
  const bool builtin =
      std::ranges::any_of(builtinScenes(), [&](const BuiltinScene& known) { return bare == known.name; });
  if (builtin) choice.scene.name = "builtin:" + choice.scene.name;
  if (choice.output.empty()) choice.output = sceneStem(choice.scene.name) + ".glb";
  if (std::filesystem::path(choice.output).extension() != ".glb") {
    throw Error(choice.output, "expected a name that ends in .glb");
  }
  refuseOverwriting(choice.output, choice.scene.name);
  AtomicFile{choice.output};  // throws now where the file cannot be written
  Scene scene = loadSceneToDraw(choice.scene, console);
  if (choice.as_spheres) {
    const SceneSpheres spheres = spheresForDrawing(scene, choice.scene.name, true, console, choice.spheres);
    scene = spheresInPlace(scene, spheres, pose(scene, choice.time_s));
  }
  writeGlb(scene, choice.output);
  remarkLostLight(scene, console);
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.triangleCount();
  if (console.json) {
    console.print(
        jsonText({{"scene", choice.scene.name}, {"output", choice.output}, {"triangles", triangles}}));
  } else {
    console.remark(fmt::format("wrote {} ({} triangles)", choice.output, countText(triangles)));
  }
  return kDone;
}

std::function<int()> declareScene(CLI::App& app, Console& console) {
  const auto choice = std::make_shared<WriteChoice>();
  addSceneOptions(app, choice->scene);
  addOutput(app, choice->output, "FILE", "a .glb; by default the scene's name");
  const auto setSpheres = [choice](const std::string& text) {
    choice->as_spheres = true;
    if (text != "auto") choice->spheres = parseInteger("--as-spheres", text, {1, 4096});
  };
  app.add_option_function<std::string>(
         "--as-spheres", setSpheres,
         "in place of everything that casts its spheres as techniques take them, that many or "
         "auto: what is left of a model when it is traced")
      ->type_name("N|auto");
  addNumber(app, "--time", choice->time_s, {0.0, 1e6}, "SECONDS", "instant at which those stand")
      ->default_str("0");
  addConsoleOptions(app, console, true);
  return [choice, &console] { return runScene(*choice, console); };
}

}  // namespace

extern const Verb kSceneVerb;
const Verb kSceneVerb = {
    "scene", "writes a built-in scene, or a model of another format, as .glb",
    "gloam scene cornell -o cornell.glb | a scene made by code; `gloam list --scenes` names them\n"
    "gloam scene bunny.obj --ground -o bunny.glb | another format, with a floor\n"
    "gloam scene walker --as-spheres 26 -o spheres.glb | what proxies take it for, to be path traced\n",
    declareScene};

}  // namespace gloam::cli
