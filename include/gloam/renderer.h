// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Rendering: a device, a scene, a technique, a picture. Everything that a technique can be asked for is declared here as
// data (TechniqueInfo, Option): the command line, the viewer and the docs are generated from it.
#pragma once

#include <gloam/image.h>
#include <gloam/scene.h>

#include <map>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace gloam {

struct SceneSpheres;
struct SceneEmission;

// ---- Options --------------------------------------------------------------------------------------------------------

using OptionValue = std::variant<bool, int, float, std::string>;

/// One thing that can be set, declared once. The type follows from `default_value`; a string is one of `choices`.
struct Option {
  const char* name;  ///< snake_case; `--prt.order 5` on the command line
  OptionValue default_value;
  double minimum = 0.0, maximum = 0.0;  ///< numbers only
  std::vector<const char*> choices;     ///< strings only
  const char* help = "";
};

/// Values for a list of options; what was not set has its default.
class Settings {
 public:
  Settings() = default;
  explicit Settings(std::span<const Option> options) : options_(options.begin(), options.end()) {}
  /// Parses and checks. Throws Error that names the option, the value and what was expected (range or choices).
  void set(const std::string& name, const std::string& text);
  bool flag(const char* name) const;
  int integer(const char* name) const;
  float number(const char* name) const;
  const std::string& choice(const char* name) const;
  /// All options with their present values, as text, in order of declaration.
  std::vector<std::pair<std::string, std::string>> list() const;

 private:
  const OptionValue& value(const char* name) const;
  std::vector<Option> options_;
  std::map<std::string, OptionValue> values_;
};

struct TechniqueInfo {
  const char* name;     ///< folder, namespace, command-line value, shader and timer prefix
  const char* summary;  ///< one line
  Coverage covers;
  std::span<const Option> options;
  bool needs_bake = false;     ///< renders only scenes whose meshes carry Transfer
  bool needs_spheres = false;  ///< renders only with Renderer::setSpheres; its option "spheres" says how many
  bool needs_emission = false;  ///< besides: renders only with Renderer::setEmission
  Coverage (*covers_with)(const Settings&) = nullptr;  ///< where options change `covers`, which holds by default
};
/// The light that a technique computes with these options of its own.
Coverage coverageWith(const TechniqueInfo& info, const Settings& settings);
/// The one table of techniques.
std::span<const TechniqueInfo> techniques();
/// Throws Error that lists the names.
const TechniqueInfo& technique(const std::string& name);

// ---- Devices --------------------------------------------------------------------------------------------------------

struct DeviceInfo {
  int index = 0;
  std::string name, driver;
  bool software = false;
};
/// Usable Vulkan 1.3 devices, real GPUs first. Throws Error (with the package to install) where there is no loader.
std::vector<DeviceInfo> devices();

/// Vulkan handles of a host engine, as void pointers so that this header needs no Vulkan. The engine keeps ownership.
struct HostDevice {
  void* instance = nullptr;         ///< VkInstance
  void* physical_device = nullptr;  ///< VkPhysicalDevice
  void* device = nullptr;  ///< VkDevice with scalarBlockLayout, dynamicRendering, synchronization2 enabled
  void* queue = nullptr;   ///< VkQueue, graphics and compute
  unsigned queue_family = 0;
};

// ---- Scenes that show nothing ---------------------------------------------------------------------------------------

/// A line for each point or spot lamp that stands inside a closed mesh, facing outward, of which the eye is outside.
std::vector<std::string> buriedLamps(const Scene& scene, const PosedScene& posed, const glm::vec3& eye);

// ---- Rendering ------------------------------------------------------------------------------------------------------

struct RenderOptions {
  int width = 1024, height = 1024;  ///< 1 to 16384
  int supersample = 1;              ///< 1 to 4: that many times the size in each direction, box-filtered
  std::string technique = "irradiance";
  Settings settings;           ///< of that technique
  int shadow_map_size = 1024;  ///< texels a side for punctual lights
  bool background = true;      ///< draw the environment behind the scene; else black, alpha 0
  bool timings = false;        ///< fill RenderedFrame::passes
  bool layers = true;          ///< normal, depth, albedo and object besides the light
  bool parts = true;           ///< its direct and indirect part besides the sum; without them frames are read back faster
  /// Any image of the frame by name ("frame.irradiance_direct", "prt.irradiance_indirect"; Renderer::imageNames() lists
  /// them) as one more layer of that name, for eyes; empty: none.
  std::string show;
};

struct PassTime {
  std::string name;
  double milliseconds = 0.0;  ///< by device timestamps; wall clock for host passes
};

/// Linear radiance. `layers` holds R, G, B, A of the sum and the layers that docs/images.md names.
struct RenderedFrame {
  LayeredImage layers;
  std::vector<PassTime> passes;
  std::size_t memory_bytes = 0;  ///< device memory held
  Warnings warnings;             ///< what this frame left out or made smaller, one line each
};

/// Device memory of one thing: "frame.environment", "prt.transfer".
struct MemoryUse {
  std::string name;
  std::size_t bytes = 0;
};

/// The frame's light as a display shows it: R, G, B, A in linear 0 to 1, as writePng takes it.
Image toDisplay(const LayeredImage& layers, const DisplayOptions& options);

/// Draws frames of one scene. Not thread-safe; movable.
class Renderer {
 public:
  /// `device`: empty for the best one, an index, or a part of its name. Throws Error.
  explicit Renderer(const std::string& device = "");
  explicit Renderer(const HostDevice& host);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Uploads the scene and its own environment; the renderer keeps its own copy of what it needs. Throws Error where the
  /// device has no room for it.
  void setScene(const Scene& scene);
  /// Sphere sets (gloam/spheres.h) of the scene that was set, for techniques that need them; setScene() forgets them.
  /// Throws Error where no scene was set or the sets belong to another.
  void setSpheres(const Scene& scene, const SceneSpheres& spheres);
  /// What the spheres that were set send (gloam/spherical_lights.h), for techniques that need it; setSpheres() and setScene()
  /// forget it. Throws Error where no spheres were set or it belongs to others.
  void setEmission(const Scene& scene, const SceneEmission& emission);
  /// Distant light in place of the scene's own. An empty environment means no light from afar.
  void setEnvironment(const Environment& environment);

  /// Draws one frame. Throws Error where the technique cannot light this scene, an option is unknown or out of range, the
  /// pose does not fit the scene, or the picture is too large for the device.
  RenderedFrame render(const PosedScene& posed, const PosedCamera& camera, const RenderOptions& options);

  /// Names that RenderOptions::show takes, of the frame that was drawn last.
  std::vector<std::string> imageNames() const;

  DeviceInfo device() const;
  std::vector<MemoryUse> memory() const;  ///< everything held on the device, the largest first
  int validationMessages() const;  ///< with GLOAM_VALIDATION=1

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gloam
