// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gloam/renderer.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "frame/frame.h"
#include "renderer/emission_set.h"
#include "renderer/proxy_set.h"
#include "renderer/read_back.h"
#include "techniques/technique.h"

namespace gloam {

struct Renderer::Impl {
  explicit Impl(std::unique_ptr<gpu::Device> d)
      : device(std::move(d)), graph(*device), environment(*device) {}

  Technique& techniqueFor(const std::string& name) {
    std::unique_ptr<Technique>& technique = techniques[name];
    if (!technique) technique = makeTechnique(name, *device);
    return *technique;
  }
  void checkSize(const frame::FrameOptions& options) const;
  bool repeats(const RenderOptions& options, const Settings& settings);

  std::unique_ptr<gpu::Device> device;
  gpu::FrameGraph graph;
  frame::EnvironmentLight environment;
  std::optional<frame::GpuScene> scene;
  std::optional<ProxySet> proxies;
  std::optional<EmissionSet> sent;
  std::map<std::string, std::unique_ptr<Technique>> techniques;
  frame::FrameMemory memory;
  std::string request;  ///< of the last frame
  bool relit = true;    ///< since then: by another light, or other spheres
};

namespace {

constexpr int kMaxSize = 16384;
constexpr int kMaxSupersample = 4;
constexpr int kLeastShadowMap = 16, kLargestShadowMap = 8192;

void checkRange(const char* name, int value, int low, int high) {
  if (value < low || value > high)
    throw Error(fmt::format("option '{}'", name), fmt::format("{} is not from {} to {}", value, low, high));
}

frame::FrameOptions frameOptions(const RenderOptions& options) {
  checkRange("width", options.width, 1, kMaxSize);
  checkRange("height", options.height, 1, kMaxSize);
  checkRange("supersample", options.supersample, 1, kMaxSupersample);
  checkRange("shadow_map_size", options.shadow_map_size, kLeastShadowMap, kLargestShadowMap);
  return {.width = options.width,
          .height = options.height,
          .supersample = options.supersample,
          .shadow_map_size = options.shadow_map_size,
          .background = options.background,
          .layers = options.layers,
          .motion = options.show == "frame.motion",
          .show = options.show};
}

/// The technique's own options with the values that were given. Throws Error for those of another technique.
Settings settingsFor(const TechniqueInfo& info, const Settings& given) {
  Settings settings(info.options);
  const auto values = given.list();
  for (const auto& [name, value] : values) {
    const bool known =
        std::any_of(info.options.begin(), info.options.end(),
                    [&, &wanted = name](const Option& option) { return wanted == option.name; });
    if (!known) throw Error(fmt::format("technique {}", info.name), fmt::format("has no option '{}'", name));
  }
  for (const auto& [name, value] : values) settings.set(name, value);
  return settings;
}

gpu::HostDevice hostDevice(const HostDevice& host) {
  return {.instance = static_cast<VkInstance>(host.instance),
          .physical_device = static_cast<VkPhysicalDevice>(host.physical_device),
          .device = static_cast<VkDevice>(host.device),
          .queue = static_cast<VkQueue>(host.queue),
          .queue_family = host.queue_family};
}

}  // namespace

void Renderer::Impl::checkSize(const frame::FrameOptions& options) const {
  const std::string size =
      fmt::format("{} x {} pixels at supersample {}", options.width, options.height, options.supersample);
  const int longest = std::max(options.width, options.height) * options.supersample;
  if (longest > static_cast<int>(device->limits().max_image_size))
    throw Error("size", fmt::format("{} is beyond the {} pixels a side that {} draws at once", size,
                                    device->limits().max_image_size, device->info().name));
  const std::size_t needed = frame::estimateBytes(options), had = device->info().memory_bytes;
  if (had > 0 && needed > had)
    throw Error("size", fmt::format("{} needs {} MiB of device memory; {} has {} MiB", size, needed >> 20,
                                    device->info().name, had >> 20));
}

/// Whether all but scene and camera is as in the last frame.
bool Renderer::Impl::repeats(const RenderOptions& options, const Settings& settings) {
  std::string now = fmt::format("{} {} {} {} {}", options.technique, options.supersample, options.background,
                                options.layers, options.show);
  for (const auto& [name, value] : settings.list()) now += fmt::format(" {}={}", name, value);
  const bool same = now == std::exchange(request, now);
  return !std::exchange(relit, false) && same;
}

Renderer::Renderer(const std::string& device)
    : impl_(std::make_unique<Impl>(gpu::Device::create({.choice = device}))) {}
Renderer::Renderer(const HostDevice& host)
    : impl_(std::make_unique<Impl>(gpu::Device::adopt(hostDevice(host)))) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::setScene(const Scene& scene) {
  impl_->scene.reset();  // frees the old one's memory first
  impl_->proxies.reset();
  impl_->sent.reset();
  impl_->scene.emplace(*impl_->device, scene);
  impl_->memory = {};
  setEnvironment(scene.environment);
}

void Renderer::setSpheres(const Scene& scene, const SceneSpheres& spheres) {
  if (!impl_->scene) throw Error("renderer", "no scene was set");
  impl_->sent.reset();
  impl_->proxies.emplace(scene, spheres);
  impl_->relit = true;
}

void Renderer::setEmission(const Scene& scene, const SceneEmission& emission) {
  if (!impl_->proxies) throw Error("renderer", "no sphere sets were set");
  impl_->sent.emplace(scene, impl_->proxies->spheres(), emission, impl_->proxies->shares());
}

void Renderer::setEnvironment(const Environment& environment) {
  impl_->environment.set(environment);
  impl_->relit = true;
}

RenderedFrame Renderer::render(const PosedScene& posed, const PosedCamera& camera,
                               const RenderOptions& options) {
  const TechniqueInfo& info = gloam::technique(options.technique);
  const Settings settings = settingsFor(info, options.settings);
  frame::FrameOptions frame_options = frameOptions(options);
  impl_->checkSize(frame_options);
  if (!impl_->scene) throw Error("renderer", "no scene was set");
  Technique& technique = impl_->techniqueFor(info.name);
  frame_options.repeats = impl_->repeats(options, settings);
  std::vector<frame::Proxy> proxies;
  std::vector<frame::Patch> flats;
  frame::Emission sent;
  if (info.needs_spheres) {
    if (!impl_->proxies) throw Error("renderer", fmt::format("{}: no sphere sets were set", info.name));
    const std::vector<PosedSphere> spheres = impl_->proxies->drawnIn(posed);
    proxies = impl_->proxies->proxiesOf(spheres);
    frame_options.proxies = proxies;
    flats = impl_->proxies->flats(posed);
    frame_options.flats = flats;
    if (info.needs_emission) {
      if (!impl_->sent) throw Error("renderer", fmt::format("{}: what spheres send was not set", info.name));
      sent = impl_->sent->posed(posed, spheres);
      frame_options.emission = &sent;
    }
  }
  gpu::FrameGraph& graph = impl_->graph;

  RenderedFrame result;
  graph.begin();
  graph.setTimed(options.timings);
  const frame::FrameImages images = frame::recordFrame(
      graph, *impl_->scene, impl_->environment, posed, camera, frame_options,
      [&](gpu::FrameGraph& g, const frame::FrameInputs& inputs) {
        return technique.record(g, inputs, settings);
      },
      impl_->memory, result.warnings);
  graph.execute();
  graph.wait();
  result.layers = readLayers(images, options.parts);
  if (!options.show.empty())
    result.layers.add(options.show, {"R", "G", "B"},
                      readShown(graph, options.show, options.width, options.height));
  if (options.timings) {
    for (const gpu::PassTime& time : graph.times()) result.passes.push_back({time.name, time.milliseconds});
  }
  result.memory_bytes = impl_->device->memoryBytes();
  return result;
}

std::vector<std::string> Renderer::imageNames() const {
  return shownNames(impl_->graph);
}

DeviceInfo Renderer::device() const {
  const gpu::DeviceInfo& info = impl_->device->info();
  return {info.index, info.name, info.driver, info.software};
}

std::vector<MemoryUse> Renderer::memory() const {
  std::map<std::string, std::size_t> bytes;  // two techniques side by side have images of one name
  for (const gpu::MemoryUse& use : impl_->device->memory()) bytes[use.name] += std::size_t(use.bytes);
  std::vector<MemoryUse> uses;
  for (const auto& [name, sum] : bytes) uses.push_back({name, sum});
  std::ranges::sort(uses, std::greater(), &MemoryUse::bytes);
  return uses;
}

int Renderer::validationMessages() const {
  return static_cast<int>(gpu::validationMessages());
}

Image toDisplay(const LayeredImage& layers, const DisplayOptions& options) {
  return toneMapped(layers.image("", {"R", "G", "B", "A"}, "frame"), options);
}

}  // namespace gloam
