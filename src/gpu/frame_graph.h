// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A frame as a list of passes. They run in the order in which they are written down; each says what it reads
// and writes, and barriers, layouts and timers follow from that.
//
//   graph.begin();
//   auto log_visibility = graph.create("proxies.log_visibility", ImageDesc{.width = w, .height = h});
//   graph.compute("proxies.accumulate", proxies_accumulate_spv)
//       .read("receivers", in.receivers).read("proxies", proxies_).write("log_visibility", log_visibility)
//       .push(AccumulateParams{.proxy_count = n}).dispatchOver(log_visibility);
//   graph.execute();
#pragma once

#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "gpu/pass.h"

namespace gloam::gpu {

struct PassTime {
  std::string name;
  double milliseconds = 0.0;
};

/// An image that lives across frames: what was written into `current` is `previous` in the next frame, zero
/// at first.
struct ImageHistory {
  ImageRef previous, current;
};
struct BufferHistory {
  BufferRef previous, current;
};

/// An image that frames ask for with a key of what it is made of. `holds`: an earlier frame wrote it with the same key, and it
/// is read as it stands; else this frame writes all of it.
struct KeptImage {
  ImageRef image;
  bool holds = false;
};

/// For a window or a host engine: what to wait for before the frame and to signal after it.
struct SubmitInfo {
  VkSemaphore wait = VK_NULL_HANDLE, signal = VK_NULL_HANDLE;
};

class FrameGraph {
 public:
  explicit FrameGraph(Device& device);
  ~FrameGraph();
  FrameGraph(const FrameGraph&) = delete;
  FrameGraph& operator=(const FrameGraph&) = delete;
  Device& device() const;

  /// Starts a new frame; forgets the passes of the last one. Resources that 16 frames did not ask for go.
  void begin();

  // ---- Resources. Names are unique within a frame: "proxies.log_visibility"
  // ----------------------------------------
  /// Lives as long as frames keep asking for it under this name; contents are those of this frame alone: a
  /// pass that reads it before another wrote it is an Error.
  ImageRef create(const std::string& name, const ImageDesc& desc);
  BufferRef create(const std::string& name, const BufferDesc& desc);
  /// A buffer with these contents, for what changes every frame (camera, lights).
  template <class T>
  BufferRef upload(const std::string& name, std::span<const T> data) {
    static_assert(std::is_trivially_copyable_v<T>);
    return uploadBytes(name, std::as_bytes(data));
  }
  template <class T>
  BufferRef upload(const std::string& name, const std::vector<T>& data) {
    return upload(name, std::span<const T>(data));
  }
  template <class T>
  BufferRef uploadOne(const std::string& name, const T& value) {
    return upload(name, std::span<const T>(&value, 1));
  }
  /// Gives a resource that lives elsewhere a name in this frame. Passes take such resources without this,
  /// too.
  ImageRef import(const std::string& name, const Image& image);
  BufferRef import(const std::string& name, const Buffer& buffer);
  ImageHistory history(const std::string& name, const ImageDesc& desc);
  BufferHistory history(const std::string& name, const BufferDesc& desc);
  /// Stays while frames ask for it, of a few sizes where they are small. An empty key never holds; nothing does before setKeeps().
  KeptImage keep(const std::string& name, const ImageDesc& desc, const std::string& key);
  /// Whether kept images may hold in this frame. Off at first: then all of a frame is drawn.
  void setKeeps(bool keeps);
  /// Forgets what all history holds: the frame that begins next starts from zero.
  void resetHistory();

  /// By name, from this frame or, after execute, the one that ran; empty if there is none. Contents stay
  /// until the next execute: `find("proxies.log_visibility").image().downloadFloats()`.
  ImageRef find(const std::string& name) const;
  BufferRef findBuffer(const std::string& name) const;
  std::vector<std::string> imageNames() const;

  // ---- Passes. "room.verb" names the pass in errors, timers and captures
  // -------------------------------------------
  ComputePass& compute(const std::string& name, const ShaderCode& code);
  RasterPass& raster(const std::string& name, const ShaderCode& vertex, const ShaderCode& fragment);
  /// Depth only.
  RasterPass& raster(const std::string& name, const ShaderCode& vertex);
  HostPass& host(const std::string& name);
  /// Depth images take the first component. All mips and layers that `image` refers to.
  void clear(const std::string& name, ImageRef image, const ClearColor& value = {0, 0, 0, 0});
  /// Every 32-bit word becomes `word`.
  void clear(const std::string& name, BufferRef buffer, std::uint32_t word = 0);
  /// Same size and format: all bits. Else, for colour formats with filtering: scaled, bilinear.
  void copy(const std::string& name, ImageRef from, ImageRef to);
  void copy(const std::string& name, BufferRef from, BufferRef to);
  /// The pixels of one mip as they are kept, layer after layer, rows from the top without gaps, and back.
  void copy(const std::string& name, ImageRef from, BufferRef to);
  void copy(const std::string& name, BufferRef from, ImageRef to);
  /// Brings an imported image into a layout that someone else expects after the frame (presentation, a host
  /// engine).
  void leaveIn(ImageRef image, VkImageLayout layout);

  // ---- Running
  // ------------------------------------------------------------------------------------------------------
  /// Submits all passes; waits only inside host passes and where the frame before the last is still running.
  void execute(const SubmitInfo& submit = {});
  /// Until the last executed frame is done.
  void wait();
  /// Timers cost a little: off at first. On software drivers, whose timestamps do not wait for the rasteriser,
  /// every pass is then submitted alone and timed by the host's clock.
  void setTimed(bool timed);
  /// Of the last executed frame (waits for it), in recorded order; passes of one name are summed. Empty if
  /// not timed.
  std::vector<PassTime> times();
  /// Bytes of transient and history resources.
  std::uint64_t memoryBytes() const;

 private:
  struct State;
  BufferRef uploadBytes(const std::string& name, std::span<const std::byte> data);
  std::unique_ptr<State> state_;
};

}  // namespace gloam::gpu
