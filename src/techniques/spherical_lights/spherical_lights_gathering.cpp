// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Guerrero, Jeschke, Wimmer 2008, section 6: the second pass, at receivers of a picture, and from there to all pixels (PX-8). Points
// that are lit from scratch stand in a picture of their own, so that the same kernel lights them.
#include <algorithm>
#include <bit>

#include "frame/quad_lists.h"
#include "shaders/spherical_lights_shaders.h"
#include "techniques/spherical_lights/spherical_lights_step.h"

namespace gloam::spherical_lights {

namespace {

constexpr int kMostRows = 8192;  // of a picture of points, on any device

/// Points that receive, in a picture; `groups`: of a dispatch over as many as there are, else all.
struct Points {
  gpu::ImageRef position, normal;
  int width = 0, height = 0;
  gpu::BufferRef groups = {};
};
struct Pictures {
  gpu::ImageRef direct, indirect;
};

/// One that is shown is black where nothing is written: lists fill a part of theirs. To be made before the pass that writes it.
gpu::ImageRef createPicture(const Step& step, const std::string& name, VkFormat format, int width,
                            int height) {
  const gpu::ImageRef image =
      step.graph.create(name, gpu::ImageDesc{.format = format, .width = width, .height = height});
  if (step.inputs.show == name) step.graph.clear(name, image);
  return image;
}

Pictures recordPoints(const Step& step, gpu::BufferRef sent, const Points& points, const std::string& name) {
  const auto image = [&](const char* what, VkFormat format) {
    return createPicture(step, name + what, format, points.width, points.height);
  };
  const Pictures got{image("direct", kHalves), image("indirect", kHalves)};
  const gpu::ImageRef visibility = image("visibility", VK_FORMAT_R32_SFLOAT),
                      unblocked = image("unblocked", kHalves);
  const bool is_quick = quick(step.blocking, step.visibility, step.rows.objects.size());
  const bool hierarchy = step.params.coarse > 0 && !points.groups;  // listed ones are no clusters
  Cuts cuts{step.levels, step.levels};
  if (hierarchy) cuts = recordCuts(step, sent, points.position);
  const auto groups = std::bit_ceil(std::max(8u, std::uint32_t(step.rows.objects.size())));
  auto& pass =
      step.graph.compute(points.groups ? "spherical_lights.gather_listed" : "spherical_lights.gather",
                         is_quick ? spherical_lights_receive_spv : spherical_lights_gather_spv);
  if (!is_quick) {
    pass.specialize("visibility_kind", step.visibility).read("meets", step.meets);
  } else {
    pass.specialize("most_groups", groups)
        .specialize("hierarchy", hierarchy)
        .specialize("by_lanes", step.by_lanes)
        .read("listed", step.listed)
        .read("cuts", cuts.levels)
        .read("ratios", cuts.ratios);
  }
  pass.specialize("blocking", step.blocking)
      .specialize("has_indirect", step.indirect)
      .specialize("glows", !step.rows.glow.empty())
      .read("receiver_position", points.position)
      .read("receiver_normal", points.normal)
      .read("spheres", step.spheres)
      .read("objects", step.objects)
      .read("sent", sent)
      .read("glow", step.glow)
      .read("blocking_patches", step.blocking_patches)
      .read("sending_patches", step.sending_patches)
      .read("patch_radiance", step.patch_radiance)
      .read("light", step.light)
      .write("direct", got.direct)
      .write("indirect", got.indirect)
      .write("visibility", visibility)
      .write("unblocked", unblocked)
      .push(step.params);
  if (points.groups)
    pass.dispatchIndirect(points.groups);
  else
    pass.dispatchOver(got.direct);
  return got;
}

Pictures recordUpsampling(const Step& step, gpu::BufferRef sent, const frame::ReceiverLevel& level,
                          const Pictures& coarse) {
  gpu::FrameGraph& graph = step.graph;
  const frame::GBuffer& gbuffer = step.inputs.gbuffer;
  const auto image = [&](const char* name, VkFormat format, int width, int height) {
    return createPicture(step, name, format, width, height);
  };
  const Pictures full{image("spherical_lights.direct_full", kHalves, gbuffer.width, gbuffer.height),
                      image("spherical_lights.indirect_full", kHalves, gbuffer.width, gbuffer.height)};
  const frame::QuadPlan quads = frame::planQuads(gbuffer, level, kPointColumns * std::uint32_t(kMostRows));
  const auto empty = [&](const char* name, std::uint32_t capacity) {
    return frame::emptyQuadList(graph, name, capacity, kPointColumns / 8);
  };
  const gpu::BufferRef misfits = empty("spherical_lights.misfits", quads.misfits),
                       repairs = empty("spherical_lights.repairs", quads.repairs);
  graph.compute("spherical_lights.upsample", spherical_lights_upsample_spv)
      .read("frame_view", step.inputs.view)
      .read("depth", gbuffer.depth)
      .read("normals", gbuffer.normals)
      .read("receiver_normal", level.normal_depth)
      .read("direct", coarse.direct)
      .read("indirect", coarse.indirect)
      .readWrite("misfits", misfits)
      .write("direct_full", full.direct)
      .write("indirect_full", full.indirect)
      .push(quads.upsampleParams())
      .dispatchOver(quads.columns, quads.rows);
  constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;
  const int height = int((quads.repairs + kPointRow - 1) / kPointRow) * 8;
  const Points points{image("spherical_lights.point_position", kFloats, int(kPointColumns), height),
                      image("spherical_lights.point_normal", kFloats, int(kPointColumns), height),
                      int(kPointColumns), height, repairs};
  graph.compute("spherical_lights.widen", spherical_lights_widen_spv)
      .read("frame_view", step.inputs.view)
      .read("depth", gbuffer.depth)
      .read("normals", gbuffer.normals)
      .read("receiver_normal", level.normal_depth)
      .read("direct", coarse.direct)
      .read("indirect", coarse.indirect)
      .read("misfits", misfits)
      .readWrite("repairs", repairs)
      .readWrite("direct_full", full.direct)
      .readWrite("indirect_full", full.indirect)
      .write("point_position", points.position)
      .write("point_normal", points.normal)
      .push(quads.widenParams())
      .dispatchIndirect(misfits);
  const Pictures repaired = recordPoints(step, sent, points, "spherical_lights.point_");
  graph.compute("spherical_lights.repair", spherical_lights_repair_spv)
      .read("point_direct", repaired.direct)
      .read("point_indirect", repaired.indirect)
      .read("repairs", repairs)
      .readWrite("direct_full", full.direct)
      .readWrite("indirect_full", full.indirect)
      .push(UpsampleParams{quads.divisor, quads.repairs})
      .dispatchIndirect(repairs);
  return full;
}

Pictures atVertices(const Step& step, gpu::BufferRef sent) {
  const VertexPoints vertices = recordVertices(step);
  const Pictures lit = recordPoints(
      step, sent, {vertices.position, vertices.normal, vertices.position.width(), vertices.position.height()},
      "spherical_lights.vertex_");
  const frame::GBuffer& gbuffer = step.inputs.gbuffer;
  const auto image = [&](const char* name) {
    return step.graph.create(
        name, gpu::ImageDesc{.format = kHalves, .width = gbuffer.width, .height = gbuffer.height});
  };
  const Pictures full{image("spherical_lights.direct_full"), image("spherical_lights.indirect_full")};
  recordInterpolation(step, vertices, lit.direct, lit.indirect, full.direct, full.indirect);
  return full;
}

frame::Lighting lightingOf(const Step& step, const Pictures& got, int divisor) {
  frame::Lighting lighting;
  lighting.has_local_direct = step.lamps_are_balls;
  lighting.irradiance.push_back({got.direct, frame::Path::kDirect, divisor, true});
  if (step.indirect) lighting.irradiance.push_back({got.indirect, frame::Path::kIndirect, divisor, true});
  return lighting;
}

}  // namespace

frame::Lighting recordGathering(const Step& step, gpu::BufferRef sent) {
  if (step.at_vertices) return lightingOf(step, atVertices(step, sent), 1);
  const frame::ReceiverLevel& level = step.inputs.receivers.at(step.divisor);
  Pictures got = recordPoints(step, sent, {level.position, level.normal_depth, level.width, level.height},
                              "spherical_lights.");
  int divisor = level.divisor;
  if (divisor > 1 && step.repair) {
    got = recordUpsampling(step, sent, level, got);
    divisor = 1;
  }
  return lightingOf(step, got, divisor);
}

}  // namespace gloam::spherical_lights
