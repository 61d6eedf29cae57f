// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// For the tests of all rooms that use a device: one device an executable, and silence of the validation layer, also
// about what is left behind at the end.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>

#include "gpu/device.h"

#ifdef __SANITIZE_ADDRESS__
/// Drivers and layers keep memory until the process ends; what we leave on the device, the validation layer counts.
extern "C" __attribute__((weak, used)) const char* __asan_default_options() {
  return "detect_leaks=0";
}  // NOLINT
#endif

namespace gloam::gpu {

class TestDevice : public testing::Environment {
 public:
  void SetUp() override { setenv("GLOAM_VALIDATION", "1", 0); }
  void TearDown() override {
    device_.reset();
    EXPECT_EQ(validationMessages(), 0u) << "the validation layer had something to say; see stderr";
  }
  Device& device() {
    if (!device_) device_ = Device::create();
    return *device_;
  }

 private:
  std::unique_ptr<Device> device_;
};

inline auto* const kTestDevice =
    static_cast<TestDevice*>(testing::AddGlobalTestEnvironment(new TestDevice));  // gtest owns it

/// Throws Error, and so fails the test with its message, where there is no device.
inline Device& testDevice() {
  return kTestDevice->device();
}

/// The message of the Error that a call throws; empty if it throws none.
template <class F>
std::string errorOf(F&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace gloam::gpu
