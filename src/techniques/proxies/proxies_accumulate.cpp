// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan et al. 2007, section 4.1: each proxy touches the receivers within its sphere of influence alone. The paper splats; lists
// of tiles do the same sum with every receiver read once and no blending of 20 floats a proxy.
#include "techniques/proxies/proxies_accumulate.h"

#include "shaders/proxies_shaders.h"

namespace gloam::proxies {

namespace {

/// Of each tile, a bit for every proxy that reaches it.
gpu::BufferRef recordBits(const Step& step, const std::string& name, gpu::BufferRef bounds,
                          std::uint32_t tiles, bool repairs) {
  const std::uint32_t words = step.params.words;
  const auto bits = step.graph.create(
      name + "_bits", gpu::BufferDesc{.bytes = std::size_t(tiles) * words * sizeof(std::uint32_t)});
  step.graph.compute(name, proxies_tiles_spv)
      .specialize("repairs", repairs)
      .read("bounds", bounds)
      .read("proxies", step.proxies)
      .write("bits", bits)
      .push(TileParams{tiles, step.proxy_count, step.params.least_sine})
      .dispatch((tiles + 63) / 64, words);
  return bits;
}

gpu::BufferRef recordTiles(const Step& step) {
  const int side = int(kTileSize);
  const int columns = (step.level.width + side - 1) / side, rows = (step.level.height + side - 1) / side;
  const auto tiles = std::uint32_t(columns * rows);
  const auto bounds =
      step.graph.create("proxies.bounds", gpu::BufferDesc{.bytes = tiles * sizeof(TileBounds)});
  step.graph.compute("proxies.bounds", proxies_bounds_spv)
      .read("receiver_position", step.level.position)
      .write("bounds", bounds)
      .dispatchOver(columns, rows);
  return recordBits(step, "proxies.tiles", bounds, tiles, false);
}

Sums makeSums(const Step& step) {
  return {step.image("proxies.log_visibility_packed", kFloats, 4),
          step.image("proxies.indirect_sum", kFloats)};
}

}  // namespace

RepairTiles recordRepairTiles(const Step& step, gpu::BufferRef repairs, std::uint32_t capacity) {
  const frame::GBuffer& gbuffer = step.inputs.gbuffer;
  const auto across = [](int pixels) { return (std::uint32_t(pixels) + kRepairTile - 1) / kRepairTile; };
  const std::uint32_t columns = across(gbuffer.width), tiles = columns * across(gbuffer.height);
  const auto bounds =
      step.graph.create("proxies.repair_bounds", gpu::BufferDesc{.bytes = tiles * sizeof(TileBounds)});
  step.graph.clear("proxies.repair_bounds", bounds);
  step.graph.compute("proxies.repair_bounds", proxies_repair_bounds_spv)
      .read("frame_view", step.inputs.view)
      .read("depth", gbuffer.depth)
      .read("repairs", repairs)
      .readWrite("bounds", bounds)
      .push(RepairBoundsParams{columns, capacity, std::uint32_t(step.level.divisor)})
      .dispatchIndirect(repairs);
  return {recordBits(step, "proxies.repair_tiles", bounds, tiles, true), columns};
}

Sums accumulateByTiles(const Step& step) {
  const gpu::BufferRef bits = recordTiles(step);
  const Sums sums = makeSums(step);
  step.graph.compute("proxies.accumulate", proxies_accumulate_spv)
      .specialize("indirect_kind", step.indirect)
      .specialize("exponential", step.exponential)
      .specialize("by_lanes", step.by_lanes)
      .read("receiver_position", step.level.position)
      .read("receiver_normal", step.level.normal_depth)
      .read("proxies", step.proxies)
      .read("bits", bits)
      .read("log_table", step.log_table)
      .read("alone_table", step.alone_table)
      .read("operator_table", step.operator_table)
      .read("light", step.light)
      .write("log_visibility", sums.log_visibility)
      .write("indirect", sums.sent)
      .push(step.params)
      .dispatchOver(sums.sent);
  return sums;
}

Sums accumulateBySplats(const Step& step) {
  const Sums sums = makeSums(step);
  const gpu::RasterState adding{.blend = gpu::Blend::kAdd};
  const gpu::ClearColor nothing(0.0f, 0.0f, 0.0f, 0.0f);
  const SplatParams params{step.params, std::uint32_t(step.level.width), std::uint32_t(step.level.height),
                           std::uint32_t(step.level.divisor)};
  // Four targets are what every device has; so the two sums are two passes, as in the paper.
  auto& shadow =
      step.graph.raster("proxies.splat_shadow", proxies_splat_vert_spv, proxies_splat_shadow_frag_spv)
          .state(adding)
          .read("frame_view", step.inputs.view)
          .read("receiver_position", step.level.position)
          .read("receiver_normal", step.level.normal_depth)
          .read("proxies", step.proxies)
          .read("log_table", step.log_table)
          .push(params);
  const char* outputs[] = {"log0", "log1", "log2", "log3"};
  for (int i = 0; i < 4; ++i) shadow.color(outputs[i], sums.log_visibility.layer(i), nothing);
  if (step.proxy_count > 0) shadow.draw().vertices(6, step.proxy_count);
  if (step.indirect == kIndirectOff) {
    step.graph.clear("proxies.indirect_sum", sums.sent);
    return sums;
  }
  auto& indirect =
      step.graph.raster("proxies.splat_indirect", proxies_splat_vert_spv, proxies_splat_indirect_frag_spv)
          .state(adding)
          .specialize("indirect_kind", step.indirect)
          .specialize("exponential", step.exponential)
          .read("frame_view", step.inputs.view)
          .read("receiver_position", step.level.position)
          .read("receiver_normal", step.level.normal_depth)
          .read("proxies", step.proxies)
          .read("alone_table", step.alone_table)
          .read("operator_table", step.operator_table)
          .read("light", step.light)
          .color("sent", sums.sent, nothing)
          .push(params);
  if (step.proxy_count > 0) indirect.draw().vertices(6, step.proxy_count);
  return sums;
}

}  // namespace gloam::proxies
