// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "visibility/visibility.h"

#include <fmt/format.h>

#include <atomic>

#include "visibility/device_rays.h"
#include "visibility/host_sight.h"
#include "visibility/host_world.h"

namespace gloam::visibility {

Means meansNamed(const std::string& name) {
  return name == "host" ? Means::kHost : name == "device" ? Means::kDevice : Means::kAuto;
}

struct Visibility::State {
  explicit State(gpu::Device& d) : device(d), device_rays(d) {}
  gpu::Device& device;
  HostWorld world;
  DeviceRays device_rays;
  std::atomic<std::uint64_t> rays{0};
};

namespace {

/// The contents of a buffer in a host pass: the memory itself where it is mapped, else a copy.
template <class T>
class Contents {
 public:
  Contents(const gpu::HostAccess& access, gpu::BufferRef buffer) {
    if (buffer.buffer().mapped() != nullptr) {
      values_ = access.map<T>(buffer);
    } else {
      copy_ = access.download<T>(buffer);
      values_ = copy_;
    }
  }
  std::span<const T> values() const { return values_; }

 private:
  std::vector<T> copy_;
  std::span<const T> values_;
};

}  // namespace

Visibility::Visibility(gpu::Device& device) : state_(std::make_unique<State>(device)) {}
Visibility::~Visibility() = default;

HostWorld& Visibility::world() {
  return state_->world;
}

Means Visibility::choose(Means means) const {
  if (means != Means::kAuto) return means;
  return state_->device.info().software ? Means::kHost : Means::kDevice;
}

std::uint64_t Visibility::tracedRays() const {
  return state_->rays.load();
}

gpu::BufferRef Visibility::record(gpu::FrameGraph& graph, const std::string& name,
                                  const frame::GpuScene& scene, const Question& question, Means means) {
  State& s = *state_;
  const std::size_t bytes = std::size_t(question.point_count) * question.words * sizeof(std::uint32_t);
  const bool on_host = choose(means) == Means::kHost;
  const gpu::BufferRef visible =
      graph.create(name + "_bits", gpu::BufferDesc{.bytes = bytes, .host_visible = on_host});
  if (bytes == 0) return visible;
  if (!on_host) {
    s.device_rays.record(graph, name, scene, s.world, question, visible);
    return visible;
  }
  auto& pass = graph.host(name);
  HostWorld::reads(pass, scene);
  pass.read(question.points).read(question.lights).read(question.sets).write(visible);
  pass.run([&s, &scene, question, visible](gpu::HostAccess& access) {
    s.world.update(access, scene);
    const Contents<SightPoint> points(access, question.points);
    const Contents<std::byte> lights(access, question.lights);
    const Contents<SightSet> sets(access, question.sets);
    const LightRows rows{lights.values().data(), question.light_bytes,
                         lights.values().size() / question.light_bytes};
    s.rays += traceSight(s.world.tracer(), points.values().first(question.point_count), rows,
                         sets.values().first(question.set_count), question.words,
                         access.map<std::uint32_t>(visible));
  });
  return visible;
}

}  // namespace gloam::visibility
