// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "scene_inputs.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <glm/gtc/matrix_transform.hpp>

namespace gloam::cli {
namespace {

constexpr const char* kDefaultSky = "sky:mild";
constexpr const char* kGroundName = "ground";  // as addGround calls its node
constexpr float kDefaultFovDeg = 45.0f;

std::string cameraNames(const PosedScene& posed) {
  if (posed.cameras.empty()) return "the scene has none";
  std::vector<std::string> names;
  for (std::size_t i = 0; i < posed.cameras.size(); ++i) {
    const std::string& name = posed.cameras[i].camera.name;
    names.push_back(name.empty() ? std::to_string(i) : fmt::format("{} ({})", i, name));
  }
  return "expected " + listed(names);
}

// A name wins over an index: a camera may be called "2".
PosedCamera findCamera(const PosedScene& posed, const std::string& wanted) {
  for (const PosedCamera& camera : posed.cameras) {
    if (camera.camera.name == wanted) return camera;
  }
  std::size_t index = 0;
  const char* end = wanted.data() + wanted.size();
  const auto [stopped, problem] = std::from_chars(wanted.data(), end, index);
  if (problem != std::errc{} || stopped != end || index >= posed.cameras.size()) {
    throw Error("--camera", fmt::format("no camera '{}': {}", wanted, cameraNames(posed)));
  }
  return posed.cameras[index];
}

PosedCamera cameraAt(const glm::vec3& eye, const glm::vec3& target) {
  const glm::vec3 forward = target - eye;
  if (glm::dot(forward, forward) < 1e-12f) throw Error("--eye", "is where --target is");
  const bool vertical = std::abs(glm::normalize(forward).y) > 0.9999f;
  const glm::vec3 up = vertical ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
  PosedCamera posed;
  posed.camera.vertical_fov_rad = glm::radians(kDefaultFovDeg);
  posed.world_from_view = glm::inverse(glm::lookAt(eye, target, up));
  return posed;
}

/// A floor is wider than what stands on it: the camera is placed before, and stays with the scene when it is baked.
void addFramingCamera(Scene& scene) {
  const PosedCamera framing = framingCamera(pose(scene, 0.0f), 1.0f);
  Node node;
  node.name = "framing camera";
  node.matrix = framing.world_from_view;
  node.camera = int(scene.cameras.size());
  scene.cameras.push_back(framing.camera);
  scene.cameras.back().name = node.name;
  scene.roots.push_back(int(scene.nodes.size()));
  scene.nodes.push_back(std::move(node));
}

/// What is baked cannot be given a floor any more, but may have one.
void addGroundOnce(Scene& scene, const std::string& name, Console& console) {
  const auto holdsTransfer = [](const Mesh& mesh) { return mesh.transfer != nullptr; };
  if (std::ranges::none_of(scene.meshes, holdsTransfer)) {
    if (scene.cameras.empty()) addFramingCamera(scene);
    addGround(scene);
    return;
  }
  const auto isGround = [](const Node& node) { return node.name == kGroundName; };
  if (std::ranges::none_of(scene.nodes, isGround)) {
    throw Error("--ground",
                fmt::format("{} is baked without a floor; bake it anew with gloam bake --ground", name));
  }
  console.remark(fmt::format("--ground: {} holds its floor already", name));
}

}  // namespace

void addSceneOptions(CLI::App& app, SceneChoice& choice) {
  CLI::Option* scene = addName(app, "SCENE", choice.name, "SCENE",
                               "a .glb, .gltf, .obj, .ply, .off, .fbx or .3ds file, or builtin:NAME");
  if (choice.name.empty()) {
    scene->required();
  } else {
    scene->default_str(choice.name);
  }
  app.add_flag("--ground", choice.ground, "puts a round floor under the scene");
}

void addLightOptions(CLI::App& app, LightChoice& choice) {
  addName(app, "--env", choice.environment, "LIGHT",
          "light from far away: an equirectangular .exr or .hdr, a sky by name (sky:mild), or none")
      ->group("Light");
  addNumber(app, "--env-rotation", choice.rotation_deg, {-36000.0, 36000.0}, "DEGREES",
            "turns that light about the vertical axis, counter-clockwise seen from above")
      ->group("Light");
  addNumber(app, "--env-intensity", choice.intensity, {0.0, 1e6}, "FACTOR", "multiplies that light")
      ->group("Light");
  const auto addLights = [&choice](const std::vector<std::string>& texts) {
    choice.light_texts = texts;
    choice.lights = AnimatedLights::parse(texts);
  };
  app.add_option_function<std::vector<std::string>>(
         "--light", addLights,
         "adds a distant light, as often as wanted: disc?…, constant?…, gradient?…, sky:NAME?…, "
         "probe:FILE?…, or a .json "
         "list of them; values are numbers or keys, azimuth=0:0,4:360")
      ->type_name("LIGHT")
      ->allow_extra_args(false)
      ->group("Light");
}

void addViewOptions(CLI::App& app, ViewChoice& choice) {
  const auto setSize = [&choice](const std::string& text) {
    choice.size = parseSize("--size", text, kMaxSize);
  };
  app.add_option_function<std::string>("--size", setSize, "pixels; one number for a square")
      ->type_name("WxH")
      ->default_str("1024x1024")
      ->group("View");
  addInteger(app, "--supersample", choice.supersample, {1, 4}, "N",
             "antialiasing: N times the size each way, averaged")
      ->default_str("1")
      ->group("View");
  addText(app, "--camera", choice.camera, "NAME|INDEX", "a camera of the scene; its first by default")
      ->group("View");
  const auto addPoint = [&app](const char* name, std::optional<glm::vec3>& point, const char* help) {
    const auto set = [&point, name](const std::string& text) { point = parseVector(name, text); };
    app.add_option_function<std::string>(name, set, help)->type_name("X,Y,Z")->group("View");
  };
  addPoint("--eye", choice.eye, "a camera here, in metres");
  addPoint("--target", choice.target, "that looks at this point; the middle of the scene by default");
  const auto setFov = [&choice](const std::string& text) {
    choice.fov_deg = float(parseNumber("--fov", text, {1.0, 170.0}));
  };
  app.add_option_function<std::string>("--fov", setFov, "vertical field of view")
      ->type_name("DEGREES")
      ->group("View");
  const auto setOrtho = [&choice](const std::string& text) {
    choice.ortho_m = float(parseNumber("--ortho", text, {1e-6, 1e9}));
  };
  app.add_option_function<std::string>("--ortho", setOrtho, "orthographic, so many metres high")
      ->type_name("METRES")
      ->group("View");
  addNumber(app, "--time", choice.time_s, {0.0, 1e6}, "SECONDS", "instant of the animation")
      ->default_str("0")
      ->group("View");
}

void addDeviceOption(CLI::App& app, std::string& device) {
  addText(app, "--device", device, "NAME|INDEX", "as `gloam list --devices` shows them; the best by default");
}

Scene loadSceneToDraw(const SceneChoice& choice, Console& console) {
  Scene scene = loadScene(choice.name, console.progress());
  console.endProgress();
  const bool any = std::ranges::any_of(scene.meshes, [](const Mesh& mesh) { return !mesh.indices.empty(); });
  if (!any) throw Error(choice.name, "holds no triangles: nothing to draw");
  if (choice.ground) {
    addGroundOnce(scene, choice.name, console);
  }
  console.remarks(choice.name, scene.warnings);
  return scene;
}

void remarkLostLight(const Scene& scene, Console& console) {
  const std::string& name = scene.environment.name;
  if (scene.environment.empty() || name.starts_with("sky:")) return;
  console.remark(fmt::format("the scene's own light{} does not go into a .glb: give it by --env",
                             name.empty() ? "" : fmt::format(", {},", name)));
}

Environment chooseBaseEnvironment(const Scene& scene, const LightChoice& choice, Console& console) {
  Environment environment;
  if (choice.environment.empty()) {
    environment = scene.environment;
    if (environment.empty() && scene.lights.empty() && choice.lights.empty()) {
      environment = loadEnvironment(kDefaultSky);
      const bool glows = std::ranges::any_of(
          scene.materials, [](const Material& material) { return material.emission != glm::vec3(0.0f); });
      console.remark(
          glows
              ? fmt::format("no lamp in the scene and no --env: lit by {} beside what glows (--env none: by "
                            "that alone)",
                            kDefaultSky)
              : fmt::format("no light in the scene and no --env: lit by {}", kDefaultSky));
    }
  } else if (choice.environment != "none") {
    environment = loadEnvironment(choice.environment);
    console.remarks(choice.environment, environment.warnings);
  }
  environment.rotation_rad += glm::radians(choice.rotation_deg);
  environment.intensity *= choice.intensity;
  return environment;
}

static std::string nameOf(const Environment& base, const LightChoice& choice) {
  if (choice.lights.empty()) return base.name;
  return base.empty() ? choice.lights.text() : base.name + " + " + choice.lights.text();
}

Environment environmentAt(const Environment& base, const LightChoice& choice, float time_s) {
  if (choice.lights.empty()) return base;
  Environment painted = paintLights(base, choice.lights.at(time_s));
  painted.name = nameOf(base, choice);
  return painted;
}

Environment describedAt(const DistantLight& base, const LightChoice& choice, float time_s) {
  std::vector<DistantLight> lights = choice.lights.at(time_s);
  if (!base.map->empty()) lights.insert(lights.begin(), base);
  Environment described = describeLights(std::move(lights));
  described.name = nameOf(*base.map, choice);
  return described;
}

Environment chooseEnvironment(const Scene& scene, const LightChoice& choice, Console& console, float time_s) {
  return environmentAt(chooseBaseEnvironment(scene, choice, console), choice, time_s);
}

PosedCamera chooseCamera(const PosedScene& posed, const ViewChoice& choice, Console& console) {
  if (choice.target && !choice.eye) throw Error("--target", "needs --eye");
  if (choice.eye && !choice.camera.empty()) throw Error("--eye", "and --camera exclude each other");
  PosedCamera camera;
  if (choice.eye) {
    camera = cameraAt(*choice.eye, choice.target.value_or((posed.bounds_min + posed.bounds_max) * 0.5f));
  } else if (!choice.camera.empty()) {
    camera = findCamera(posed, choice.camera);
  } else if (!posed.cameras.empty()) {
    camera = posed.cameras.front();
  } else {
    camera = framingCamera(posed, choice.aspect());
    console.remark("no camera in the scene: one that shows all of it (--eye, --target and --fov choose)");
  }
  if (choice.fov_deg && choice.ortho_m) throw Error("--fov", "and --ortho exclude each other");
  if (choice.ortho_m) {
    camera.camera.perspective = false;
    camera.camera.half_height = 0.5f * *choice.ortho_m;
  }
  if (choice.fov_deg) {
    if (!camera.camera.perspective) throw Error("--fov", "the camera is orthographic");
    camera.camera.vertical_fov_rad = glm::radians(*choice.fov_deg);
  }
  return camera;
}

void remarkBuriedLamps(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                       Console& console) {
  for (const std::string& line : buriedLamps(scene, posed, glm::vec3(camera.world_from_view[3])))
    console.remark(line);
}

std::string sceneStem(const std::string& name) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (name.starts_with(kBuiltin)) {  // "builtin:spheres?detail=2"
    return name.substr(kBuiltin.size(), name.find('?') - kBuiltin.size());
  }
  // "cloud.raw?size=64x64x64"; other names may hold question marks
  const std::size_t end = name.find(".raw?") != std::string::npos || name.find(".vdb?") != std::string::npos
                              ? name.find('?')
                              : std::string::npos;
  const std::string stem = std::filesystem::path(name.substr(0, end)).stem().string();
  return stem.empty() ? "scene" : stem;
}

}  // namespace gloam::cli
