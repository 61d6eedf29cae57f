// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Shader functions, run on a device, against the C++ functions of the same name.
#include <gloam/sh.h>
#include <gtest/gtest.h>

#include "gpu/frame_graph.h"
#include "gpu/test_device.h"
#include "math/brdf.h"
#include "math/sampling.h"
#include "math/test_shaders/math_twins_shared.h"
#include "shaders/math_test_shaders.h"

namespace gloam {
namespace {

using math_test::TwinInput;
using math_test::TwinOutput;

std::vector<TwinInput> makeInputs(std::size_t count) {
  std::vector<TwinInput> inputs(count);
  sampling::Rng random(21);
  for (TwinInput& input : inputs) {
    input.direction = sampling::uniformSphere(random.next2());
    input.normal = sampling::uniformSphere(random.next2());
    input.to_view = sampling::uniformSphere(random.next2());
    for (float& value : input.f) value = random.next() - 0.5f;
    for (float& value : input.g) value = random.next() - 0.5f;
    for (glm::vec3& value : input.light) value = random.next3() - 0.5f;
    input.exponent = 1.0f + 200.0f * random.next();
    input.metallic = random.next();
    input.roughness = 0.3f + 0.7f * random.next();
    input.base_color = random.next3();
  }
  return inputs;
}

sh::Sh function(int order, const float* values) {
  sh::Sh f(order);
  for (int i = 0; i < f.size(); ++i) f[i] = values[i];
  return f;
}

void expectNear(const float* got, const sh::Sh& want, const char* what) {
  for (int i = 0; i < want.size(); ++i) EXPECT_NEAR(got[i], want[i], 3e-6f) << what << ' ' << i;
}

void expectNear(const glm::vec3& got, const glm::vec3& want, const char* what) {
  const float tolerance = 1e-5f * (1.0f + glm::length(want));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], tolerance) << what << ' ' << i;
}

TEST(DeviceTwins, ShadersCalculateWhatCppDoes) {
  const std::vector<TwinInput> inputs = makeInputs(61);
  gpu::FrameGraph graph(gpu::testDevice());
  graph.begin();
  const auto outputs =
      graph.create("test.outputs", gpu::BufferDesc{.bytes = inputs.size() * sizeof(TwinOutput)});
  graph.compute("test.twins", math_twins_spv)
      .read("Inputs", graph.upload("test.inputs", inputs))
      .write("Outputs", outputs)
      .dispatchOver(static_cast<std::uint32_t>(inputs.size()));
  graph.execute();
  const std::vector<TwinOutput> got = outputs.buffer().download<TwinOutput>();
  ASSERT_EQ(got.size(), inputs.size());
  for (std::size_t k = 0; k < got.size(); ++k) {
    const TwinInput& in = inputs[k];
    expectNear(got[k].basis3, sh::evaluate(3, in.direction), "shEvaluate3");
    expectNear(got[k].basis6, sh::evaluate(6, in.direction), "shEvaluate6");
    const sh::Zh zonal{5, {in.f[0], in.f[1], in.f[2], in.f[3], in.f[4]}};
    expectNear(got[k].zonal5, sh::rotateZonal(zonal, in.direction), "shRotateZonal5");
    expectNear(got[k].product3, sh::product(function(3, in.f), function(3, in.g)), "shProduct3");
    expectNear(got[k].product4, sh::product(function(4, in.f), function(4, in.g)), "shProduct4");
    expectNear(got[k].product5, sh::product(function(5, in.f), function(5, in.g)), "shProduct5");
    expectNear(got[k].product6, sh::product(function(6, in.f), function(6, in.g)), "shProduct6");
    for (int order = 3; order <= 6; ++order) {
      sh::ShRgb light(order);
      for (int i = 0; i < light.size(); ++i) light[i] = in.light[i];
      expectNear(got[k].irradiance[order - 3], sh::irradiance(light, in.normal), "shIrradiance");
      expectNear(got[k].phong[order - 3], brdf::shadePhong(light, in.direction, in.exponent), "shadePhong");
      if (order != 4) continue;
      const sh::ShRgb convolved = sh::convolve(light, sh::clampedCosine(4));
      for (int i = 0; i < 16; ++i) expectNear(got[k].cosine4[i], convolved[i], "shConvolveCosine4");
    }
    const brdf::Lobes lobes = brdf::makeLobes(in.base_color, in.metallic, in.roughness);
    const glm::vec3 want = brdf::evaluateLobes(lobes, in.normal, in.to_view, in.direction);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(got[k].lobes[i], want[i], 1e-4f * (1.0f + want[i])) << "evaluateLobes";
  }
}

}  // namespace
}  // namespace gloam
