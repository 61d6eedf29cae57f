// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/pass_check.h"

#include <algorithm>

#include "gpu/binding_check.h"
#include "gpu/format.h"

namespace gloam::gpu {
namespace {

std::string passPlace(const std::string& name) {
  return "pass '" + name + "'";
}

std::string listNames(const Interface& interface) {
  std::string names;
  for (const auto& binding : interface.bindings) names += (names.empty() ? "" : ", ") + binding.name;
  return names.empty() ? "none" : names;
}

void checkNames(const std::string& place, const Interface& interface, const Bindings& bindings) {
  for (const auto& resource : bindings.resources) {
    if (resource.name.empty()) continue;
    if (interface.find(resource.name) == nullptr) {
      throw Error(place, "binding '" + resource.name + "': " + interface.name +
                             " has no such binding or never uses it; its bindings: " + listNames(interface));
    }
    if (lookUp(resource.name, nullptr, bindings) != &resource) {
      throw Error(place, "binding '" + resource.name + "' was given twice");
    }
  }
}

void checkPush(const std::string& place, const Interface& interface, const std::vector<std::byte>& push) {
  if (push.size() == interface.push_bytes) return;
  if (interface.push_bytes == 0) {
    throw Error(place, interface.name + " has no push block or never uses it; " +
                           std::to_string(push.size()) + " bytes were pushed");
  }
  throw Error(place, "the push block of " + interface.name + " has " + std::to_string(interface.push_bytes) +
                         " bytes; " + std::to_string(push.size()) + " were pushed");
}

Access shaderAccess(const Binding& binding, const BoundResource& given) {
  Access access;
  if ((binding.stages & VK_SHADER_STAGE_COMPUTE_BIT) != 0)
    access.stages |= VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  if ((binding.stages & VK_SHADER_STAGE_VERTEX_BIT) != 0)
    access.stages |= VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
  if ((binding.stages & VK_SHADER_STAGE_FRAGMENT_BIT) != 0)
    access.stages |= VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  if (binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) {
    access.access = VK_ACCESS_2_UNIFORM_READ_BIT;
  } else if (binding.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ||
             binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) {
    if (binding.readable) access.access |= VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
    if (binding.writable) access.access |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  } else {
    access.access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  }
  if (given.image) access.layout = layoutFor(binding.type, given.image.image());
  return access;
}

bool overlap(const Touch& a, const Touch& b) {
  if (a.buffer && b.buffer) {
    return a.buffer.offset() < b.buffer.offset() + b.buffer.bytes() &&
           b.buffer.offset() < a.buffer.offset() + a.buffer.bytes();
  }
  const ImageRange &x = a.image.range(), &y = b.image.range();
  return x.mip < y.mip + y.mips && y.mip < x.mip + x.mips && x.layer < y.layer + y.layers &&
         y.layer < x.layer + x.layers;
}

/// Touches of one pass, each part once.
class Gathered {
 public:
  explicit Gathered(std::string place) : place_(std::move(place)) {}

  void add(Touch touch) {
    const void* key = touch.buffer ? static_cast<const void*>(&touch.buffer.buffer()) : &touch.image.image();
    auto& of_resource = by_resource_[key];
    for (const std::size_t index : of_resource) {
      Touch& known = touches_[index];
      if (!overlap(known, touch)) continue;
      if (known.binding != touch.binding) checkTogether(known, touch);
      const bool same_part = touch.buffer || known.image.range() == touch.image.range();
      if (!same_part || known.access.layout != touch.access.layout) continue;
      known.access.stages |= touch.access.stages;
      known.access.access |= touch.access.access;
      known.reads |= touch.reads;
      known.writes |= touch.writes;
      return;
    }
    of_resource.push_back(touches_.size());
    touches_.push_back(std::move(touch));
  }
  std::vector<Touch> take() { return std::move(touches_); }

 private:
  void checkTogether(const Touch& a, const Touch& b) const {
    const std::string& name = a.buffer ? a.buffer.name() : a.image.name();
    if (a.writes || b.writes) {
      throw Error(place_, "'" + name + "' is bound as '" + a.binding + "' and as '" + b.binding +
                              "', and one of them writes what the other touches");
    }
    if (a.access.layout != b.access.layout) {
      throw Error(place_, "'" + name + "' is bound as '" + a.binding + "' and as '" + b.binding +
                              "', once sampled and once as storage; bind it the same way twice");
    }
  }

  std::string place_;
  std::vector<Touch> touches_;
  std::map<const void*, std::vector<std::size_t>> by_resource_;
};

/// All that shaders see: the names of a program against the pass and, in a raster pass, one of its draws.
void gatherBindings(const Device& device, const std::string& name, const Interface& interface,
                    const Bindings& pass, const Bindings* draw, Gathered& gathered) {
  const std::string place = passPlace(name);
  for (const auto& binding : interface.bindings) {
    const BoundResource* given = lookUp(binding.name, draw, pass);
    const std::string where = place + ", binding '" + binding.name + "'";
    if (given == nullptr) {
      throw Error(where,
                  std::string("nothing was given for ") + kindName(binding.type) + " of " + interface.name);
    }
    checkBinding(device, where, binding, *given);
    if (!given->image && !given->buffer) continue;
    gathered.add({binding.name, given->image, given->buffer, shaderAccess(binding, *given),
                  given->use != Use::kWrite, given->use == Use::kWrite || given->use == Use::kReadWrite});
  }
  specializationOf(place, interface, pass, draw);
}

void gatherAddressed(const std::string& place, const Interface& interface, const Bindings& bindings,
                     Gathered& gathered) {
  Binding everywhere;
  everywhere.stages = interface.stages;
  for (const auto& resource : bindings.resources) {
    if (!resource.name.empty()) continue;
    if (!resource.buffer)
      throw Error(place, "an empty reference was given for what the shader reaches by address");
    everywhere.writable = resource.use != Use::kRead;
    gathered.add({"(by address)",
                  {},
                  resource.buffer,
                  shaderAccess(everywhere, resource),
                  resource.use != Use::kWrite,
                  everywhere.writable});
  }
}

std::vector<Touch> checkCompute(const Device& device, const ComputePass& pass) {
  const std::string place = passPlace(pass.name);
  const Interface& interface = pass.program->interface();
  Gathered gathered(place);
  if (!pass.finished) throw Error(place, "was never dispatched");
  checkNames(place, interface, pass.bindings());
  gatherBindings(device, pass.name, interface, pass.bindings(), nullptr, gathered);
  gatherAddressed(place, interface, pass.bindings(), gathered);
  checkPush(place, interface, pass.bindings().push);
  groupsOf(device, pass);
  if (pass.indirect) {
    if (pass.indirect.bytes() < sizeof(VkDispatchIndirectCommand)) {
      throw Error(place, "buffer '" + pass.indirect.name() + "' is too small for three group counts");
    }
    gathered.add({"(indirect)",
                  {},
                  pass.indirect,
                  {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT},
                  true,
                  false});
  }
  return gathered.take();
}

void checkTarget(const std::string& place, const ImageRef& target, const ImageRef& first,
                 VkImageUsageFlags usage) {
  if (!target) throw Error(place, "an empty reference was given as a target");
  const std::string its = "target '" + target.name() + "'";
  if (target.range().mips != 1 || target.range().layers != 1) {
    throw Error(place, its + " is more than one mip or layer; name one with mip() and layer()");
  }
  if ((target.image().usage() & usage) == 0) {
    throw Error(place, its + " (" + formatInfo(target.format()).name + ") cannot be drawn into that way");
  }
  if (target.width() != first.width() || target.height() != first.height()) {
    throw Error(place, its + " is " + std::to_string(target.width()) + " x " +
                           std::to_string(target.height()) + ", '" + first.name() + "' is " +
                           std::to_string(first.width()) + " x " + std::to_string(first.height()));
  }
}

void gatherTargets(const RasterPass& pass, const Interface& interface, Gathered& gathered) {
  const std::string place = passPlace(pass.name);
  if (pass.colors.empty() && !pass.depth_image) throw Error(place, "draws into nothing");
  const ImageRef first = pass.colors.empty() ? pass.depth_image : pass.colors.front().image;
  for (const auto& target : pass.colors) {
    const auto is_it = [&](const StageOutput& output) { return output.name == target.output; };
    if (std::none_of(interface.outputs.begin(), interface.outputs.end(), is_it)) {
      throw Error(place, "output '" + target.output + "': " + interface.name +
                             " has no such output or never writes it");
    }
    checkTarget(place, target.image, first, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    gathered.add({target.output,
                  target.image,
                  {},
                  {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                   VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL},
                  false,
                  true});
  }
  for (const auto& output : interface.outputs) {
    const auto is_it = [&](const ColorTarget& target) { return target.output == output.name; };
    if (std::none_of(pass.colors.begin(), pass.colors.end(), is_it)) {
      throw Error(place, "output '" + output.name + "' of " + interface.name + " has no target");
    }
  }
  if (!pass.depth_image) return;
  checkTarget(place, pass.depth_image, first, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  Access access{VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
  if (!pass.depth_read_only) {
    access.access |= VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    access.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
  }
  gathered.add({"(depth)", pass.depth_image, {}, access, !pass.depth_clear, !pass.depth_read_only});
}

std::vector<Touch> checkRaster(const Device& device, const RasterPass& pass) {
  const std::string place = passPlace(pass.name);
  const Interface& interface = pass.program->interface();
  Gathered gathered(place);
  gatherTargets(pass, interface, gathered);
  checkNames(place, interface, pass.bindings());
  gatherAddressed(place, interface, pass.bindings(), gathered);
  for (const auto& draw : pass.draws) {
    checkNames(place, interface, draw.bindings());
    gatherBindings(device, pass.name, interface, pass.bindings(), &draw.bindings(), gathered);
    gatherAddressed(place, interface, draw.bindings(), gathered);
    checkPush(place, interface, draw.bindings().push.empty() ? pass.bindings().push : draw.bindings().push);
    if (!draw.indices) continue;
    if ((std::size_t{draw.first} + draw.count) * sizeof(std::uint32_t) > draw.indices.bytes()) {
      throw Error(place, "draws indices up to " + std::to_string(std::size_t{draw.first} + draw.count) +
                             "; buffer '" + draw.indices.name() + "' has " +
                             std::to_string(draw.indices.bytes() / sizeof(std::uint32_t)));
    }
    gathered.add({"(indices)",
                  {},
                  draw.indices,
                  {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT},
                  true,
                  false});
  }
  return gathered.take();
}

std::vector<Touch> checkHost(const HostPass& pass) {
  const std::string place = passPlace(pass.name);
  if (!pass.function) throw Error(place, "was never given a function to run");
  std::vector<Touch> touches;
  for (const auto& resource : pass.resources) {
    if (!resource.buffer && !resource.image) throw Error(place, "an empty reference was given");
    touches.push_back({"(host)",
                       resource.image,
                       resource.buffer,
                       {},
                       resource.use == Use::kRead,
                       resource.use == Use::kWrite});
  }
  return touches;
}

/// Calls a function with the state of each part that a touch covers.
template <class F>
void forEachPart(const Touch& touch, F&& function) {
  if (touch.buffer) return function(touch.buffer.buffer().state().parts[0]);
  const ImageRange& range = touch.image.range();
  const auto mips = static_cast<std::size_t>(touch.image.image().desc().mips);
  auto& parts = touch.image.image().state().parts;
  for (int layer = range.layer; layer < range.layer + range.layers; ++layer) {
    for (int mip = range.mip; mip < range.mip + range.mips; ++mip) {
      function(parts[static_cast<std::size_t>(layer) * mips + static_cast<std::size_t>(mip)]);
    }
  }
}

}  // namespace

const std::string& nameOf(const Pass& pass) {
  return std::visit([](const auto& one) -> const std::string& { return one.name; }, pass);
}

bool isWritten(const Touch& touch, std::uint64_t frame) {
  bool written = true;
  forEachPart(touch, [&](const PartState& part) {
    written &= part.written_in_frame == frame || part.written_in_frame == PartState::kAlways;
  });
  return written;
}

void markWritten(const Touch& touch, std::uint64_t frame) {
  forEachPart(touch, [&](PartState& part) {
    if (part.written_in_frame != PartState::kAlways) part.written_in_frame = frame;
  });
}

VkImageLayout layoutFor(VkDescriptorType type, const Image& image) {
  if (type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) return VK_IMAGE_LAYOUT_GENERAL;
  // So that a pass can test against depth and sample it at the same time.
  if (formatInfo(image.format()).aspect == VK_IMAGE_ASPECT_DEPTH_BIT) {
    return VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  }
  return VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
}

const BoundResource* lookUp(const std::string& name, const Bindings* draw, const Bindings& pass) {
  const auto in = [&](const Bindings& bindings) -> const BoundResource* {
    for (auto it = bindings.resources.rbegin(); it != bindings.resources.rend(); ++it) {
      if (it->name == name) return &*it;
    }
    return nullptr;
  };
  const BoundResource* own = draw != nullptr ? in(*draw) : nullptr;
  return own != nullptr ? own : in(pass);
}

Specialization specializationOf(const std::string& place, const Interface& interface, const Bindings& pass,
                                const Bindings* draw) {
  Specialization values;
  const auto put = [&](const Bindings& bindings) {
    for (const auto& constant : bindings.constants) {
      const auto is_it = [&](const SpecConstant& known) { return known.name == constant.name; };
      const auto known = std::find_if(interface.constants.begin(), interface.constants.end(), is_it);
      if (known == interface.constants.end()) {
        throw Error(place, "constant '" + constant.name + "': " + interface.name +
                               " has no such specialisation constant or never uses it");
      }
      values[known->id] = constant.word;
    }
  };
  put(pass);
  if (draw != nullptr) put(*draw);
  return values;
}

std::array<std::uint32_t, 3> groupsOf(const Device& device, const ComputePass& pass) {
  const Interface& interface = pass.program->interface();
  const Specialization values = specializationOf(passPlace(pass.name), interface, pass.bindings(), nullptr);
  std::array<std::uint32_t, 3> groups = pass.size;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto own = values.find(interface.local_size_id[i]);
    const std::uint32_t local = std::max(1u, own != values.end() ? own->second : interface.local_size[i]);
    if (pass.over) groups[i] = groups[i] / local + (groups[i] % local != 0 ? 1u : 0u);
    if (groups[i] > device.limits().max_group_count[i]) {
      throw Error(passPlace(pass.name), std::to_string(groups[i]) + " work groups in one direction; '" +
                                            device.info().name + "' takes " +
                                            std::to_string(device.limits().max_group_count[i]));
    }
  }
  return groups;
}

std::vector<Touch> checkPass(const Device& device, const Pass& pass) {
  if (const auto* compute = std::get_if<ComputePass>(&pass)) return checkCompute(device, *compute);
  if (const auto* raster = std::get_if<RasterPass>(&pass)) return checkRaster(device, *raster);
  if (const auto* host = std::get_if<HostPass>(&pass)) return checkHost(*host);
  return std::get<TransferPass>(pass).touches;
}

}  // namespace gloam::gpu
