// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// gloam scene: writes a scene that is made by code, or any that can be read, as .glb.
#include <fmt/core.h>
#include <gloam/scene.h>
#include <image/atomic_file.h>

#include "json.h"
#include "output.h"
#include "scene_inputs.h"
#include "verb.h"

namespace gloam::cli {
namespace {

struct WriteChoice {
  SceneChoice scene;
  std::string output;
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
  const Scene scene = loadSceneToDraw(choice.scene, console);
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
  addConsoleOptions(app, console, true);
  return [choice, &console] { return runScene(*choice, console); };
}

}  // namespace

extern const Verb kSceneVerb;
const Verb kSceneVerb = {
    "scene", "writes a built-in scene, or a model of another format, as .glb",
    "gloam scene cornell -o cornell.glb | a scene made by code; `gloam list --scenes` names them\n"
    "gloam scene bunny.obj --ground -o bunny.glb | another format, with a floor\n",
    declareScene};

}  // namespace gloam::cli
