// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "gpu/device.h"

#include <gtest/gtest.h>

#include "gpu/device_state.h"
#include "gpu/frame_graph.h"
#include "gpu/test_device.h"
#include "gpu/test_shaders/gpu_test_shared.h"
#include "shaders/gpu_test_shaders.h"

namespace gloam::gpu {
namespace {

using testing::ExitedWithCode;

Candidate candidate(int index, const char* name, VkPhysicalDeviceType type, const char* missing = "") {
  Candidate made;
  made.info.index = index;
  made.info.name = name;
  made.info.missing = missing;
  made.type = type;
  return made;
}

const std::vector<Candidate> kMachine = {
    candidate(0, "llvmpipe (LLVM 15)", VK_PHYSICAL_DEVICE_TYPE_CPU),
    candidate(1, "Old GPU 4000", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "dynamicRendering"),
    candidate(2, "Laptop GPU", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU),
    candidate(3, "Big GPU 4090", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU),
};

TEST(DeviceChoice, PrefersGpusAndLeavesOutWhatCannotServe) {
  EXPECT_EQ(choose(kMachine, "").info.name, "Big GPU 4090");
  EXPECT_EQ(choose({kMachine[0], kMachine[1]}, "").info.name, "llvmpipe (LLVM 15)");
}

TEST(DeviceChoice, TakesAnIndexOrAPartOfAName) {
  EXPECT_EQ(choose(kMachine, "0").info.index, 0);
  EXPECT_EQ(choose(kMachine, "LLVMpipe").info.index, 0);
  EXPECT_EQ(choose(kMachine, "laptop").info.index, 2);
  EXPECT_EQ(choose(kMachine, "4090").info.index, 3);
  EXPECT_EQ(choose(kMachine, "gpu").info.index, 3);
}

TEST(DeviceChoice, ErrorsSayWhatThereIsAndWhatIsMissing) {
  EXPECT_EQ(
      errorOf([] { choose(kMachine, "radeon"); }),
      "device 'radeon': no device has this index or name; there are: 0 llvmpipe (LLVM 15), 1 Old GPU 4000, "
      "2 Laptop GPU, 3 Big GPU 4090");
  EXPECT_EQ(errorOf([] { choose(kMachine, "1"); }), "device 'Old GPU 4000': lacks dynamicRendering");
  EXPECT_NE(errorOf([] { choose({kMachine[1]}, ""); }).find("mesa-vulkan-drivers"), std::string::npos);
  EXPECT_NE(errorOf([] { choose({}, ""); }).find("mesa-vulkan-drivers"), std::string::npos);
}

TEST(Device, ListsWhatItCanBeAskedFor) {
  const auto devices = Device::list();
  ASSERT_FALSE(devices.empty());
  for (const auto& info : devices) {
    if (!info.missing.empty()) continue;
    EXPECT_EQ(Device::create({.choice = std::to_string(info.index)})->info().name, info.name);
  }
}

TEST(Device, UnknownNameOrExtensionIsAnError) {
  EXPECT_NE(errorOf([] { Device::create({.choice = "no such device"}); }).find("device 'no such device': "),
            std::string::npos);
  EXPECT_NE(errorOf([] { Device::create({.instance_extensions = {"VK_EXT_none"}}); }).find("VK_EXT_none"),
            std::string::npos);
  EXPECT_NE(errorOf([] { Device::create({.device_extensions = {"VK_EXT_none"}}); }).find("VK_EXT_none"),
            std::string::npos);
}

TEST(Device, CanBeMadeReadyForAWindow) {
  // What a viewer adds; the software driver has both without any display.
  const auto device = Device::create({.instance_extensions = {VK_KHR_SURFACE_EXTENSION_NAME},
                                      .device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME}});
  EXPECT_NE(device->vk().vkCreateSwapchainKHR, nullptr);
}

/// Runs in a process of its own, so that the environment of the others stays as it is.
TEST(DeviceDeathTest, WithoutADriverThePackageIsNamed) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        setenv("VK_ICD_FILENAMES", "/nonexistent.json", 1);
        setenv("VK_DRIVER_FILES", "/nonexistent.json", 1);
        const std::string message = errorOf([] { Device::create(); });
        const bool named = message.find("mesa-vulkan-drivers") != std::string::npos;
        std::exit(named && Device::list().empty() ? 3 : 4);
      },
      ExitedWithCode(3), "");
}

TEST(DeviceDeathTest, ValidationCountsWhatADeviceLeavesBehind) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        auto device = Device::create();
        VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
        VkSemaphore leaked = VK_NULL_HANDLE;
        device->vk().vkCreateSemaphore(device->handle(), &info, nullptr, &leaked);
        const auto before = validationMessages();
        device.reset();
        std::exit(before == 0 && validationMessages() > 0 ? 3 : 4);
      },
      ExitedWithCode(3), "vulkan validation: error: ");
}

TEST(DeviceDeathTest, ValidationSeesAMissingBarrier) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        auto device = Device::create();
        Buffer buffer(*device, "buffer", BufferDesc{.bytes = 64});
        device->runNow([&](VkCommandBuffer commands) {
          device->vk().vkCmdFillBuffer(commands, buffer.handle(), 0, 64, 1);
          device->vk().vkCmdFillBuffer(commands, buffer.handle(), 0, 64, 2);
        });
        std::exit(validationMessages() > 0 ? 3 : 4);
      },
      ExitedWithCode(3), "WRITE.AFTER.WRITE");
}

TEST(Device, AdoptsAHostsDeviceWithoutOwningIt) {
  const auto host = Device::create();
  HostDevice handles;
  handles.instance = host->instance();
  handles.physical_device = host->physicalDevice();
  handles.device = host->handle();
  handles.queue = host->queue();
  handles.queue_family = host->queueFamily();
  handles.features = host->features();
  Image owned(*host, "host.image", {.format = VK_FORMAT_R32G32B32A32_SFLOAT, .width = 8, .height = 8});
  {
    const auto guest = Device::adopt(handles);
    EXPECT_EQ(guest->handle(), host->handle());
    EXPECT_EQ(guest->info().name, host->info().name);
    const Image borrowed = Image::adopt(*guest, "host.image", owned.handle(), owned.desc(), owned.usage(),
                                        VK_IMAGE_LAYOUT_UNDEFINED);
    FrameGraph graph(*guest);
    graph.begin();
    graph.compute("test.fill", gpu_fill_spv)
        .write("target", borrowed)
        .push(gpu_test::FillParams{{1.0f, 10.0f}, 0.5f})
        .dispatchOver(borrowed);
    graph.leaveIn(borrowed, VK_IMAGE_LAYOUT_GENERAL);
    graph.execute();
    graph.wait();
  }
  // The host goes on with its device and finds the picture, in the layout that it asked for.
  owned.state().parts[0].write.layout = VK_IMAGE_LAYOUT_GENERAL;
  EXPECT_EQ(owned.downloadFloats()[4 * (8 * 3 + 2) + 2], 2.5f + 30.5f);
}

TEST(Device, AdoptingNothingIsAnError) {
  EXPECT_NE(errorOf([] { Device::adopt({}); }).find("one of them is null"), std::string::npos);
}

TEST(Device, KnowsItsMemoryByName) {
  Device& device = testDevice();
  const auto before = device.memoryBytes();
  {
    const Buffer buffer(device, "test.some_buffer", BufferDesc{.bytes = 1 << 20});
    EXPECT_GE(device.memoryBytes(), before + (1 << 20));
    bool found = false;
    for (const auto& use : device.memory()) found |= use.name == "test.some_buffer" && use.bytes >= (1 << 20);
    EXPECT_TRUE(found);
  }
  EXPECT_EQ(device.memoryBytes(), before);
}

}  // namespace
}  // namespace gloam::gpu
