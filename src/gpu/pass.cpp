// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/pass.h"

namespace gloam::gpu {

void ComputePass::dispatchOver(ImageRef image) {
  if (!image) throw Error("pass '" + name + "'", "was dispatched over an empty reference");
  dispatchOver(image.width(), image.height(), image.depth() * image.range().layers);
}

void ComputePass::dispatchOver(int width, int height, int depth) {
  if (width < 0 || height < 0 || depth < 0)
    throw Error("pass '" + name + "'", "was dispatched over a negative size");
  dispatch(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
           static_cast<std::uint32_t>(depth));
  over = true;
}

void ComputePass::dispatch(std::uint32_t groups_x, std::uint32_t groups_y, std::uint32_t groups_z) {
  size = {groups_x, groups_y, groups_z};
  finished = true;
}

void ComputePass::dispatchIndirect(BufferRef arguments) {
  if (!arguments) throw Error("pass '" + name + "'", "takes its groups from an empty reference");
  indirect = arguments;
  finished = true;
}

Draw& Draw::state(const RasterState& state) {
  own_state = state;
  return *this;
}

Draw& Draw::cull(VkCullModeFlags cull) {
  own_cull = cull;
  return *this;
}

Draw& Draw::vertices(std::uint32_t vertex_count, std::uint32_t instance_count, std::uint32_t first_vertex) {
  count = vertex_count;
  instances = instance_count;
  first = first_vertex;
  return *this;
}

Draw& Draw::indexed(BufferRef index_buffer, std::uint32_t index_count, std::uint32_t instance_count,
                    std::uint32_t first_index, std::int32_t offset, std::uint32_t instance) {
  vertices(index_count, instance_count, first_index);
  indices = index_buffer;
  vertex_offset = offset;
  first_instance = instance;
  return *this;
}

RasterPass& RasterPass::color(std::string_view output, ImageRef image) {
  colors.push_back({std::string(output), image, {}});
  return *this;
}

RasterPass& RasterPass::color(std::string_view output, ImageRef image, const ClearColor& clear) {
  colors.push_back({std::string(output), image, clear});
  return *this;
}

RasterPass& RasterPass::depth(ImageRef image) {
  depth_image = image;
  return *this;
}

RasterPass& RasterPass::depth(ImageRef image, float clear) {
  depth_clear = clear;
  return depth(image);
}

RasterPass& RasterPass::depthReadOnly(ImageRef image) {
  depth_read_only = true;
  return depth(image);
}

RasterPass& RasterPass::state(const RasterState& state) {
  pass_state = state;
  return *this;
}

RasterPass& RasterPass::viewport(int x, int y, int width, int height) {
  if (x < 0 || y < 0 || width <= 0 || height <= 0)
    throw Error("pass '" + name + "'", "has an empty viewport");
  area = VkRect2D{{x, y}, {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)}};
  return *this;
}

Draw& RasterPass::draw() {
  return draws.emplace_back();
}

RasterPass& RasterPass::record(std::function<void(VkCommandBuffer)> record_commands) {
  commands = std::move(record_commands);
  return *this;
}

HostPass& HostPass::read(BufferRef buffer) {
  resources.push_back({{}, Use::kRead, {}, buffer, {}});
  return *this;
}

HostPass& HostPass::read(ImageRef image) {
  resources.push_back({{}, Use::kRead, image, {}, {}});
  return *this;
}

HostPass& HostPass::write(BufferRef buffer) {
  resources.push_back({{}, Use::kWrite, {}, buffer, {}});
  return *this;
}

HostPass& HostPass::write(ImageRef image) {
  resources.push_back({{}, Use::kWrite, image, {}, {}});
  return *this;
}

void HostPass::run(std::function<void(HostAccess&)> host_function) {
  function = std::move(host_function);
}

namespace {

/// A host pass touches only what it said it would: the check that other passes get from their shaders.
void checkDeclared(const HostPass& pass, const void* resource, const std::string& name, bool write) {
  for (const auto& declared : pass.resources) {
    const void* known =
        declared.buffer ? static_cast<const void*>(&declared.buffer.buffer()) : &declared.image.image();
    if (known == resource && (!write || declared.use == Use::kWrite)) return;
  }
  throw Error("pass '" + pass.name + "'",
              std::string(write ? "writes '" : "reads '") + name + "' without having declared it");
}

}  // namespace

std::vector<float> HostAccess::downloadFloats(ImageRef image) const {
  checkDeclared(pass_, &image.image(), image.name(), false);
  return image.image().downloadFloats(image.range().mip, image.range().layer);
}

void HostAccess::uploadFloats(ImageRef image, std::span<const float> values) const {
  checkDeclared(pass_, &image.image(), image.name(), true);
  const_cast<Image&>(image.image()).uploadFloats(values, image.range().mip, image.range().layer);
}

void HostAccess::downloadBytes(BufferRef buffer, std::span<std::byte> bytes) const {
  checkDeclared(pass_, &buffer.buffer(), buffer.name(), false);
  buffer.buffer().downloadBytes(bytes, buffer.offset());
}

void HostAccess::uploadBytes(BufferRef buffer, std::span<const std::byte> bytes) const {
  checkDeclared(pass_, &buffer.buffer(), buffer.name(), true);
  if (bytes.size() > buffer.bytes()) {
    throw Error("pass '" + pass_.name + "'", "writes " + std::to_string(bytes.size()) + " bytes into the " +
                                                 std::to_string(buffer.bytes()) + " of '" + buffer.name() +
                                                 "'");
  }
  const_cast<Buffer&>(buffer.buffer()).uploadBytes(bytes, buffer.offset());
}

std::byte* HostAccess::mapBytes(BufferRef buffer) const {
  checkDeclared(pass_, &buffer.buffer(), buffer.name(), false);
  std::byte* mapped = buffer.buffer().mapped();
  if (mapped == nullptr) {
    throw Error("pass '" + pass_.name + "'", "maps '" + buffer.name() + "', which is not host_visible");
  }
  return mapped + buffer.offset();
}

}  // namespace gloam::gpu
