// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The exponentials of shaders against the C++ functions of the same name, as C++ and on a device.
#include <gtest/gtest.h>

#include <cmath>

#include "gpu/frame_graph.h"
#include "gpu/test_device.h"
#include "math/sh_blockers.h"
#include "math/sh_constants.h"
#include "math/sh_exp_tables.h"
#include "math/test_shaders/math_exp_twins_shared.h"
#include "shaders/math_test_shaders.h"

// The shader code as C++ (see glsl_as_cpp.h, which another file of these tests holds).
namespace gloam::exp_glsl {
using namespace glm;        // NOLINT
using namespace gloam::sh;  // NOLINT
#define out
#include "math/sh_exp_high.glsl"
#include "math/sh_log_blocker.glsl"
#undef out
}  // namespace gloam::exp_glsl

namespace gloam {
namespace {

using math_test::ExpTwinInput;
using math_test::ExpTwinOutput;

/// Sums of logs of both arrangements, 1 to 40 spheres.
std::vector<sh::Sh> someLogs(int order) {
  std::vector<sh::Sh> logs(1, sh::Sh(order));
  const sh::LogBlockerTable table = sh::makeLogBlockerTable(order, 64);
  for (const auto arrangement : {sh::Arrangement::kScattered, sh::Arrangement::kBody})
    for (const int blockers : {1, 5, 40})
      for (const auto& set : sh::randomBlockers(arrangement, blockers, 5, 11))
        logs.push_back(sh::sumOfLogs(table, set));
  return logs;
}

void expectNear(const float* got, const sh::Sh& want, const char* what) {
  float size = 0.0f;
  for (int i = 0; i < want.size(); ++i) size = std::max(size, std::abs(want[i]));
  for (int i = 0; i < want.size(); ++i)
    EXPECT_NEAR(got[i], want[i], 2e-5f * (1.0f + size)) << what << ' ' << i;
}

TEST(ExpTwins, GlslCalculatesWhatCppDoes) {
  using Exp = void (*)(const float*, float*);
  using Series = void (*)(const float*, int, float*);
  const Exp hybrid[] = {exp_glsl::shExpHybrid3, exp_glsl::shExpHybrid4, exp_glsl::shExpHybrid5,
                        exp_glsl::shExpHybrid6};
  const Exp quadratic[] = {exp_glsl::shExpQuadratic3, exp_glsl::shExpQuadratic4, exp_glsl::shExpQuadratic5,
                           exp_glsl::shExpQuadratic6};
  const Exp linear[] = {exp_glsl::shExpLinear3, exp_glsl::shExpLinear4, exp_glsl::shExpLinear5,
                        exp_glsl::shExpLinear6};
  const Series series[] = {exp_glsl::shExpSeries3, exp_glsl::shExpSeries4, exp_glsl::shExpSeries5,
                           exp_glsl::shExpSeries6};
  for (int order = 3; order <= 6; ++order) {
    std::vector<sh::Sh> functions = someLogs(order);
    functions.push_back(functions.back());
    functions.back() *= 1000.0f;  // longer than exponentials take it
    for (const sh::Sh& f : functions) {
      float h[36];
      hybrid[order - 3](f.c.data(), h), expectNear(h, sh::expHybrid(f), "shExpHybrid");
      quadratic[order - 3](f.c.data(), h), expectNear(h, sh::expQuadratic(f), "shExpQuadratic");
      linear[order - 3](f.c.data(), h), expectNear(h, sh::expLinear(f), "shExpLinear");
      if (sh::dot(f, f) > 400.0f) continue;
      series[order - 3](f.c.data(), 5, h), expectNear(h, sh::expSeries(f, 5), "shExpSeries");
    }
  }
  for (const float alpha : {0.0f, 0.2f, 0.9f, 1.0f}) {
    EXPECT_NEAR(exp_glsl::shLogBlockerCoordinate(alpha), sh::logBlockerCoordinate(alpha), 1e-7f);
    EXPECT_NEAR(exp_glsl::shLogBlockerAlpha(alpha), sh::logBlockerAlpha(alpha), 1e-7f);
  }
}

TEST(ExpTwins, ShadersCalculateWhatCppDoes) {
  std::vector<ExpTwinInput> inputs;
  for (const sh::Sh& f : someLogs(6)) {
    ExpTwinInput& input = inputs.emplace_back();
    std::copy(f.c.begin(), f.c.end(), input.f);
    input.alpha = static_cast<float>(inputs.size()) / 31.0f;
  }
  gpu::FrameGraph graph(gpu::testDevice());
  graph.begin();
  const auto outputs =
      graph.create("test.outputs", gpu::BufferDesc{.bytes = inputs.size() * sizeof(ExpTwinOutput)});
  graph.compute("test.exp_twins", math_exp_twins_spv)
      .read("Inputs", graph.upload("test.inputs", inputs))
      .write("Outputs", outputs)
      .dispatchOver(static_cast<std::uint32_t>(inputs.size()));
  graph.execute();
  const std::vector<ExpTwinOutput> got = outputs.buffer().download<ExpTwinOutput>();
  ASSERT_EQ(got.size(), inputs.size());
  for (std::size_t k = 0; k < got.size(); ++k) {
    sh::Sh f(6);
    std::copy(inputs[k].f, inputs[k].f + 36, f.c.begin());
    const auto low = [&f](int order) { return sh::truncated(f, order); };
    expectNear(got[k].hybrid3, sh::expHybrid(low(3)), "shExpHybrid3");
    expectNear(got[k].hybrid4, sh::expHybrid(low(4)), "shExpHybrid4");
    expectNear(got[k].hybrid5, sh::expHybrid(low(5)), "shExpHybrid5");
    expectNear(got[k].hybrid6, sh::expHybrid(f), "shExpHybrid6");
    expectNear(got[k].quadratic3, sh::expQuadratic(low(3)), "shExpQuadratic3");
    expectNear(got[k].quadratic4, sh::expQuadratic(low(4)), "shExpQuadratic4");
    expectNear(got[k].quadratic5, sh::expQuadratic(low(5)), "shExpQuadratic5");
    expectNear(got[k].quadratic6, sh::expQuadratic(f), "shExpQuadratic6");
    expectNear(got[k].linear4, sh::expLinear(low(4)), "shExpLinear4");
    if (sh::dot(f, f) < 400.0f) expectNear(got[k].series4, sh::expSeries(low(4)), "shExpSeries4");
    EXPECT_NEAR(got[k].coordinate, sh::logBlockerCoordinate(inputs[k].alpha), 1e-6f);
    EXPECT_NEAR(got[k].alpha, inputs[k].alpha, 1e-5f);
  }
}

}  // namespace
}  // namespace gloam
