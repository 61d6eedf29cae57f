// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Resources that frames ask for by name. Only files of this room include this.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "gpu/frame_graph.h"

namespace gloam::gpu {

class ResourcePool {
 public:
  explicit ResourcePool(Device& device) : device_(device) {}

  /// Starts frame `frame`: history that was written becomes the past, what nobody asks for any more goes.
  void begin(std::uint64_t frame);

  ImageRef create(const std::string& name, const ImageDesc& desc);
  BufferRef create(const std::string& name, const BufferDesc& desc);
  /// A mapped buffer that this frame may fill while the device reads that of the frame before.
  BufferRef createUpload(const std::string& name, std::size_t bytes);
  /// `fresh` is set where both images have just been made and `previous` has to be cleared.
  ImageHistory history(const std::string& name, const ImageDesc& desc, bool& fresh);
  BufferHistory history(const std::string& name, const BufferDesc& desc, bool& fresh);
  /// From the next frame on.
  void resetHistory();
  KeptImage keep(const std::string& name, const ImageDesc& desc, const std::string& key);
  void setKeeps(bool keeps) { keeps_ = keeps; }
  /// All passes of this frame have run or are on their way: what they wrote may be kept.
  void finish() { finished_frame_ = frame_; }
  void import(const std::string& name, const ImageRef& image);
  void import(const std::string& name, const BufferRef& buffer);

  ImageRef findImage(const std::string& name) const;
  BufferRef findBuffer(const std::string& name) const;
  std::vector<std::string> imageNames() const;
  std::uint64_t memoryBytes() const;

 private:
  template <class T>
  struct Entry {
    T resource;
    std::uint64_t used_in_frame = 0;
  };
  template <class T>
  struct Pair {
    std::array<T, 2> resources;
    std::size_t current = 0;  ///< the other one is the past
    std::uint64_t used_in_frame = 0;
  };

  struct Kept {
    Image image;
    std::string key;
    std::uint64_t keyed_in_frame = 0, used_in_frame = 0;
  };

  void claim(const std::string& name);
  Kept& keptOf(const std::string& name, const ImageDesc& desc);
  template <class T, class Desc>
  const T& transient(std::map<std::string, Entry<T>>& entries, const std::string& name, const Desc& desc);
  template <class T, class Desc>
  Pair<T>& pair(std::map<std::string, Pair<T>>& pairs, const std::string& name, const Desc& desc,
                bool& fresh);

  Device& device_;
  std::uint64_t frame_ = 0, finished_frame_ = 0;
  bool reset_history_ = false, keeps_ = false;
  std::set<std::string> names_;  ///< taken in this frame
  std::map<std::string, Entry<Image>> images_;
  std::map<std::string, Entry<Buffer>> buffers_;
  std::map<std::string, std::vector<Kept>> kept_;  ///< a few sizes of each
  std::map<std::string, Pair<Image>> image_histories_;
  std::map<std::string, Pair<Buffer>> buffer_histories_;
  std::map<std::string, ImageRef> image_names_;  ///< what find() gives
  std::map<std::string, BufferRef> buffer_names_;
};

}  // namespace gloam::gpu
