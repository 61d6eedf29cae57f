// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Options of every verb that looks at a scene: which one, under which light, from where, when.
#pragma once

#include <gloam/lights.h>
#include <gloam/renderer.h>

#include <optional>
#include <string>

#include "arguments.h"

namespace gloam::cli {

inline constexpr int kMaxSize = 16384;  ///< RenderOptions::width, height

struct SceneChoice {
  std::string name;  ///< file or builtin:NAME
  bool ground = false;
};
/// The positional SCENE (required, or "builtin:…" by default where `name` is set) and --ground.
void addSceneOptions(CLI::App& app, SceneChoice& choice);

struct LightChoice {
  std::string environment;  ///< file, "sky:NAME", "none"; empty: the scene's own
  float rotation_deg = 0.0f, intensity = 1.0f;
  std::vector<std::string> light_texts;
  AnimatedLights lights;  ///< of these texts; added to the environment
};
void addLightOptions(CLI::App& app, LightChoice& choice);

struct ViewChoice {
  glm::ivec2 size{1024, 1024};
  int supersample = 1;
  float time_s = 0.0f;
  std::string camera;  ///< name or index; empty: the first
  std::optional<glm::vec3> eye, target;
  std::optional<float> fov_deg;  ///< vertical
  std::optional<float> ortho_m;  ///< height of an orthographic camera's picture
  float aspect() const { return float(size.x) / float(size.y); }
};
void addViewOptions(CLI::App& app, ViewChoice& choice);
void addDeviceOption(CLI::App& app, std::string& device);

/// Reads the scene, says what the reader mended. Throws Error, also where there is nothing to draw.
Scene loadSceneToDraw(const SceneChoice& choice, Console& console);

/// The light that was asked for by --env; else the scene's own; else, where there is neither lamp nor --light, a mild sky, and
/// says so.
Environment chooseBaseEnvironment(const Scene& scene, const LightChoice& choice, Console& console);
/// The base with the lights of --light as they are at that time; the base itself where there are none.
Environment environmentAt(const Environment& base, const LightChoice& choice, float time_s);
/// The same to be drawn alone, without texels: microseconds a frame. `base`: mapLight() of the base.
Environment describedAt(const DistantLight& base, const LightChoice& choice, float time_s);
/// Both.
Environment chooseEnvironment(const Scene& scene, const LightChoice& choice, Console& console,
                              float time_s = 0.0f);

/// Says so where the scene brings a light along that writeGlb() leaves out: all but skies by name.
void remarkLostLight(const Scene& scene, Console& console);

/// The camera that was asked for; else the scene's first; else one that shows all of it, and says so.
PosedCamera chooseCamera(const PosedScene& posed, const ViewChoice& choice, Console& console);
/// Says which lamps send no light because they stand inside something.
void remarkBuriedLamps(const Scene& scene, const PosedScene& posed, const PosedCamera& camera,
                       Console& console);

/// "bunny" for models/bunny.glb, "cornell" for builtin:cornell.
std::string sceneStem(const std::string& name);

}  // namespace gloam::cli
