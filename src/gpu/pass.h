// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Passes as they are written down: what runs, what it touches under which name. Methods return the pass
// itself, so that a pass reads as one sentence; the last word (dispatchOver, dispatch, dispatchIndirect, run)
// checks it.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gpu/binder.h"
#include "gpu/program.h"

namespace gloam::gpu {

/// A compute pass.
class ComputePass : public Binder<ComputePass> {
 public:
  /// At least one invocation a pixel (x, y; z: layers or slices): groups are rounded up, shaders return
  /// outside.
  void dispatchOver(ImageRef image);
  void dispatchOver(int width, int height = 1, int depth = 1);
  /// Groups as they are.
  void dispatch(std::uint32_t groups_x, std::uint32_t groups_y = 1, std::uint32_t groups_z = 1);
  /// Groups from a VkDispatchIndirectCommand at the start of `arguments`.
  void dispatchIndirect(BufferRef arguments);

  std::string name;
  Program* program = nullptr;
  std::array<std::uint32_t, 3> size{0, 0, 0};  ///< invocations if `over`, else groups
  bool over = false, finished = false;
  BufferRef indirect;
};

/// One draw of a raster pass. Binds only what differs from the pass; descriptor sets in which nothing differs
/// are shared, so put per-draw textures into a set of their own (set = 1).
class Draw : public Binder<Draw> {
 public:
  /// Replaces the state, or one side of it, of the pass.
  Draw& state(const RasterState& state);
  Draw& cull(VkCullModeFlags cull);
  /// Vertices without indices: gl_VertexIndex counts from `first`.
  Draw& vertices(std::uint32_t count, std::uint32_t instances = 1, std::uint32_t first = 0);
  /// Through 32-bit indices: gl_VertexIndex is index + vertex_offset. gl_InstanceIndex counts from
  /// `first_instance`.
  Draw& indexed(BufferRef indices, std::uint32_t count, std::uint32_t instances = 1,
                std::uint32_t first_index = 0, std::int32_t vertex_offset = 0,
                std::uint32_t first_instance = 0);

  std::optional<RasterState> own_state;
  std::optional<VkCullModeFlags> own_cull;
  BufferRef indices;
  std::uint32_t count = 0, instances = 1, first = 0, first_instance = 0;
  std::int32_t vertex_offset = 0;
};

/// A value to clear to: {r, g, b, a} for floats and normalised formats, uints() for integer ones.
struct ClearColor {
  ClearColor(float r, float g, float b, float a) : value{.float32 = {r, g, b, a}} {}
  ClearColor(const std::array<float, 4>& rgba) : ClearColor(rgba[0], rgba[1], rgba[2], rgba[3]) {}  // NOLINT
  ClearColor(const std::array<std::uint32_t, 4>& rgba)                                              // NOLINT
      : ClearColor(uints(rgba[0], rgba[1], rgba[2], rgba[3])) {}
  static ClearColor uints(std::uint32_t r, std::uint32_t g = 0, std::uint32_t b = 0, std::uint32_t a = 0) {
    ClearColor color(0.0f, 0.0f, 0.0f, 0.0f);
    color.value = {.uint32 = {r, g, b, a}};
    return color;
  }
  VkClearColorValue value;
};

struct ColorTarget {
  std::string output;
  ImageRef image;
  std::optional<ClearColor> clear;
};

/// A raster pass: one program (or depth only), any number of draws.
class RasterPass : public Binder<RasterPass> {
 public:
  /// The output of the fragment shader of that name goes into `image` (one mip, one layer); kept where it is
  /// not drawn over, unless a clear value is given.
  RasterPass& color(std::string_view output, ImageRef image);
  RasterPass& color(std::string_view output, ImageRef image, const ClearColor& clear);
  RasterPass& depth(ImageRef image);
  RasterPass& depth(ImageRef image, float clear);
  /// Depth that is tested but not written, so that the pass may read it too.
  RasterPass& depthReadOnly(ImageRef image);
  RasterPass& state(const RasterState& state);
  /// In pixels; else all of the target. Clears happen only inside.
  RasterPass& viewport(int x, int y, int width, int height);
  /// Adds a draw.
  Draw& draw();
  /// Runs inside the pass after the draws, for code that records commands itself (a user interface).
  RasterPass& record(std::function<void(VkCommandBuffer)> commands);

  std::string name;
  Program* program = nullptr;
  std::vector<ColorTarget> colors;
  ImageRef depth_image;
  std::optional<float> depth_clear;
  bool depth_read_only = false;
  RasterState pass_state;
  std::optional<VkRect2D> area;
  std::deque<Draw> draws;
  std::function<void(VkCommandBuffer)> commands;
};

class HostPass;

/// What a host pass may do while it runs: the device has finished all passes before it.
class HostAccess {
 public:
  explicit HostAccess(const HostPass& pass) : pass_(pass) {}
  template <class T>
  std::vector<T> download(BufferRef buffer) const {
    std::vector<T> values(buffer.bytes() / sizeof(T));
    downloadBytes(buffer, std::as_writable_bytes(std::span(values)));
    return values;
  }
  template <class T>
  void upload(BufferRef buffer, std::span<const T> values) const {
    uploadBytes(buffer, std::as_bytes(values));
  }
  /// Host-visible buffers: the memory itself.
  template <class T>
  std::span<T> map(BufferRef buffer) const {
    return {reinterpret_cast<T*>(mapBytes(buffer)), buffer.bytes() / sizeof(T)};
  }
  std::vector<float> downloadFloats(ImageRef image) const;
  void uploadFloats(ImageRef image, std::span<const float> values) const;

 private:
  void downloadBytes(BufferRef buffer, std::span<std::byte> bytes) const;
  void uploadBytes(BufferRef buffer, std::span<const std::byte> bytes) const;
  std::byte* mapBytes(BufferRef buffer) const;
  const HostPass& pass_;
};

/// Work on the host between two passes. Its timer counts the function, not the wait for the device.
class HostPass {
 public:
  HostPass& read(BufferRef buffer);
  HostPass& read(ImageRef image);
  HostPass& write(BufferRef buffer);
  HostPass& write(ImageRef image);
  void run(std::function<void(HostAccess&)> function);

  std::string name;
  std::vector<BoundResource> resources;
  std::function<void(HostAccess&)> function;
};

}  // namespace gloam::gpu
