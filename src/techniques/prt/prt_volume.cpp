// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002, section 6: volumes lit at run time (PRT-7). The light is turned into the node's axes, each voxel
// takes two dot products, and frame/volumes.h marches through what comes out.
#include "techniques/prt/prt_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "scene/transforms.h"
#include "shaders/prt_shaders.h"

namespace gloam::prt {
namespace {

constexpr std::size_t kBlock = 64;

bool isBaked(const PlacedVolume& placed) {
  return placed.volume->transfer != nullptr;
}

std::string placeOf(const PlacedVolume& placed) {
  return fmt::format("volume '{}'", placed.volume->name);
}

void checkNumbers(const PlacedVolume& placed) {
  const Volume& volume = *placed.volume;
  checkVolume(volume, placeOf(placed));
  const Transfer& transfer = *volume.transfer;
  const std::size_t count = volume.voxels() * std::size_t(transfer.order * transfer.order);
  if (transfer.order < 1 || transfer.order > sh::kMaxOrder || transfer.direct.size() != count ||
      (!transfer.indirect.empty() && transfer.indirect.size() != 3 * count))
    throw Error(placeOf(placed), fmt::format("transfer of {} bands for {} voxels: its numbers do not fit",
                                             transfer.order, volume.voxels()));
}

/// Voxels that show anything: with transfer, or density, so that the march sees how much is in the way.
std::vector<std::uint32_t> shownVoxels(const Volume& volume) {
  const std::size_t n = std::size_t(volume.transfer->order * volume.transfer->order);
  std::vector<std::uint32_t> shown;
  for (std::size_t v = 0; v < volume.voxels(); ++v) {
    const auto row = volume.transfer->direct.begin() + std::ptrdiff_t(v * n);
    if (volume.density[v] > 0.0f ||
        std::any_of(row, row + std::ptrdiff_t(n), [](float x) { return x != 0.0f; }))
      shown.push_back(std::uint32_t(v));
  }
  return shown;
}

/// Packs the first `kept` of `stored` values of some voxels, one run for each colour.
std::vector<std::uint32_t> packed(const std::vector<float>& values, std::span<const std::uint32_t> voxels,
                                  std::size_t stored, std::size_t kept, std::size_t colors) {
  const std::size_t pairs = (kept + 1) / 2, blocks = (voxels.size() + kBlock - 1) / kBlock;
  std::vector<std::uint32_t> words(blocks * colors * pairs * kBlock, 0);
  for (std::size_t v = 0; v < voxels.size(); ++v) {
    for (std::size_t c = 0; c < colors; ++c) {
      const auto value = [&](std::size_t i) {
        return i < kept ? std::clamp(values[(voxels[v] * stored + i) * colors + c], -65504.0f, 65504.0f)
                        : 0.0f;
      };
      for (std::size_t k = 0; k < pairs; ++k)
        words[((v / kBlock * colors + c) * pairs + k) * kBlock + v % kBlock] =
            glm::packHalf2x16({value(2 * k), value(2 * k + 1)});
    }
  }
  return words;
}

}  // namespace

VolumeBuffers::VolumeBuffers(gpu::Device& device, const frame::GpuScene& scene, int order,
                             std::size_t chunk_bytes)
    : order_(order) {
  for (const PlacedVolume& placed : scene.volumes())
    if (isBaked(placed)) volumes_.push_back(makeVolume(device, placed, chunk_bytes));
}

VolumeBuffers::Baked VolumeBuffers::makeVolume(gpu::Device& device, const PlacedVolume& placed,
                                               std::size_t chunk_bytes) const {
  checkNumbers(placed);
  const Volume& volume = *placed.volume;
  const Transfer& transfer = *volume.transfer;
  Baked baked;
  baked.node = placed.node;
  baked.order = order_ > 0 ? std::min(order_, transfer.order) : transfer.order;
  baked.has_indirect = !transfer.indirect.empty();
  const std::size_t stored = std::size_t(transfer.order * transfer.order),
                    kept = std::size_t(baked.order * baked.order);
  const std::size_t limit = chunk_bytes > 0 ? chunk_bytes : device.limits().max_storage_bytes;
  const std::size_t block_bytes = (kept + 1) / 2 * 4 * kBlock * (baked.has_indirect ? 3 : 1);
  const std::size_t together = std::max<std::size_t>(1, limit / block_bytes) * kBlock;
  const std::vector<std::uint32_t> shown = shownVoxels(volume);
  for (std::size_t first = 0; first < shown.size(); first += together) {
    const std::span<const std::uint32_t> voxels(&shown[first], std::min(together, shown.size() - first));
    Chunk chunk;
    chunk.count = std::uint32_t(voxels.size());
    std::vector<VolumeVoxel> rows;
    for (const std::uint32_t v : voxels) rows.push_back({v, volume.density[v]});
    chunk.voxels = gpu::Buffer(device, "prt.volume_voxels", rows);
    chunk.direct = gpu::Buffer(device, "prt.volume_direct", packed(transfer.direct, voxels, stored, kept, 1));
    chunk.indirect = gpu::Buffer(device, "prt.volume_indirect",
                                 baked.has_indirect ? packed(transfer.indirect, voxels, stored, kept, 3)
                                                    : std::vector<std::uint32_t>(1, 0));
    baked.chunks.push_back(std::move(chunk));
  }
  return baked;
}

std::vector<frame::VolumeLight> VolumeBuffers::record(gpu::FrameGraph& graph,
                                                      const frame::FrameInputs& inputs, frame::Window window,
                                                      bool indirect) const {
  std::vector<frame::VolumeLight> lights;
  for (const Baked& baked : volumes_) {
    const auto& placed = inputs.scene.volumes();
    const auto at = std::ranges::find(placed, baked.node, &PlacedVolume::node);
    if (at == placed.end()) continue;
    const Volume& volume = *at->volume;
    const std::string suffix = fmt::format("_{}", lights.size());
    const gpu::ImageDesc desc{.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                              .width = volume.size.x,
                              .height = volume.size.y,
                              .depth = volume.size.z};
    const sh::ShRgb turned = sh::rotate(glm::transpose(rotationFactor(at->world_from_node)),
                                        frame::windowed(inputs.environment.sh(), baked.order, window));
    std::vector<glm::vec3> light(turned.coefficients().begin(), turned.coefficients().end());
    light.resize(std::size_t(baked.order * baked.order) + 1, glm::vec3(0.0f));
    const gpu::BufferRef light_buffer = graph.upload("prt.volume_light" + suffix, light);
    const auto direct = graph.create("prt.volume_radiance_direct" + suffix, desc);
    const auto further = graph.create("prt.volume_radiance_indirect" + suffix, desc);
    graph.clear("prt.volume_clear", direct);
    graph.clear("prt.volume_clear", further);
    for (const Chunk& chunk : baked.chunks) {
      const std::uint32_t groups = (chunk.count + kBlock - 1) / kBlock;
      const std::uint32_t columns = std::min(groups, graph.device().limits().max_group_count[0]);
      graph.compute("prt.volume", prt_volume_spv)
          .specialize("coefficients", baked.order * baked.order)
          .specialize("has_indirect", baked.has_indirect && indirect)
          .read("voxels", chunk.voxels)
          .read("transfer_direct", chunk.direct)
          .read("transfer_indirect", chunk.indirect)
          .read("light", light_buffer)
          .write("direct", direct)
          .write("indirect", further)
          .push(VolumeParams{volume.albedo, chunk.count})
          .dispatch(columns, (groups + columns - 1) / columns);
    }
    lights.push_back({.direct = direct,
                      .indirect = further,
                      .world_from_node = at->world_from_node,
                      .bounds_min = volume.bounds_min,
                      .bounds_max = volume.bounds_max});
  }
  return lights;
}

}  // namespace gloam::prt
