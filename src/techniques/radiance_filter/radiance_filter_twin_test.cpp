// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Each step against the same step written out on the host.
#include <climits>
#include <glm/gtc/packing.hpp>
#include <random>

#include "frame/test_frame.h"
#include "math/brdf.h"
#include "math/punctual.h"
#include "techniques/radiance_filter/radiance_filter_passes.h"

namespace gloam::radiance_filter {
namespace {

constexpr int kWidth = 61, kHeight = 47;

glm::vec3 unpacked(std::uint32_t word) {
  const glm::vec2 p = glm::unpackSnorm2x16(word);
  glm::vec3 n(p, 1.0f - std::abs(p.x) - std::abs(p.y));
  if (n.z < 0.0f) {
    const glm::vec2 q = 1.0f - glm::abs(glm::vec2(p.y, p.x));
    n.x = p.x < 0.0f ? -q.x : q.x;
    n.y = p.y < 0.0f ? -q.y : q.y;
  }
  return glm::normalize(n);
}

/// A frame with made-up values under the filter.
struct Filtered {
  std::vector<glm::uvec2> ids, normals;
  std::vector<float> positions, before, after;
  frame::FrameView view{};
  Plan plan;

  std::size_t at(glm::ivec2 p) const { return std::size_t(p.y * kWidth + p.x); }
  glm::vec3 position(glm::ivec2 p) const {
    return {positions[4 * at(p)], positions[4 * at(p) + 1], positions[4 * at(p) + 2]};
  }
  bool isSame(glm::ivec2 a, glm::ivec2 b) const {
    if (b.x < 0 || b.y < 0 || b.x >= kWidth || b.y >= kHeight) return false;
    if (ids[at(a)].x == 0 || ids[at(a)].x != ids[at(b)].x) return false;
    if (glm::dot(unpacked(normals[at(a)].y), unpacked(normals[at(b)].y)) < kCrease) return false;
    const float along = glm::dot(position(a) - view.eye, view.forward);
    const float most =
        plan.depth_threshold * float(std::max(plan.taps.x, plan.taps.y)) * glm::length(view.step_x) * along;
    return std::abs(glm::dot(unpacked(normals[at(a)].y), position(b) - position(a))) <= most;
  }
};

/// Values are `value(pixel, coefficient)`, the last the weight.
Filtered filter(const Scene& scene, const char* kind, const std::function<float(std::size_t, int)>& value,
                const char* slopes = "off") {
  frame::TestFrame frame(scene);
  Filtered result;
  gpu::Image values(gpu::testDevice(), "values",
                    {.width = kWidth, .height = kHeight, .layers = kFieldLayers});
  std::vector<float> layer(std::size_t(4 * kWidth * kHeight));
  for (int l = 0; l < kFieldLayers; ++l) {
    for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = value(i / 4, 4 * l + int(i % 4));
    values.uploadFloats(layer, 0, l);
  }
  result.before = values.downloadFloats(0, 2);
  const PosedScene posed = pose(scene, 0.0f);
  Settings settings(info().options);
  for (const auto& [name, text] :
       {std::pair("sets", "4"), std::pair("sets_down", "3"), std::pair("filter", kind),
        std::pair("views", "on"), std::pair("apart", "off"), std::pair("slopes", slopes)})
    settings.set(name, text);
  frame.draw(posed, posed.cameras.at(0), {.width = kWidth, .height = kHeight},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               result.plan = planOf(settings, kWidth, kHeight, inputs.warnings);
               inputs.receivers.at(1);
               recordFilter(graph, inputs, result.plan, {.values = values, .exposure = {}, .points = {}});
               return frame::Lighting{};
             });
  result.ids = frame.ids();
  result.normals = frame.graph.find("frame.normals_packed").image().download<glm::uvec2>();
  result.positions = frame.floats("frame.receiver_position_1");
  result.view = frame.graph.findBuffer("frame.view").buffer().download<frame::FrameView>().at(0);
  const gpu::Image& filtered = frame.graph.find("radiance_filter.filtered_packed").image();
  result.after = filtered.downloadFloats(0, 2);
  const std::vector<float> weights = filtered.downloadFloats(0, kFieldLayers - 1);
  for (std::size_t i = 0; i < result.after.size(); ++i) {
    const float weight = weights[4 * (i / 4) + 3];
    result.after[i] = weight > 0.0f ? result.after[i] / weight : 0.0f;
  }
  return result;
}

/// Where tap k of a line is found: in the window, or the next pixel of its set on the other side; -1: nowhere.
int wayTo(int k, int taps, const std::function<bool(int)>& is_same) {
  const int way = k - taps / 2, other = way < 0 ? way + taps : way - taps;
  return is_same(way) ? way : (is_same(other) ? other : INT_MAX);
}

double onePass(const Filtered& f, glm::ivec2 p, std::size_t channel) {
  double sum = 0.0, weight = 0.0;
  for (int ky = 0; ky < f.plan.taps.y; ++ky) {
    for (int kx = 0; kx < f.plan.taps.x; ++kx) {
      const int x = kx - f.plan.taps.x / 2, y = ky - f.plan.taps.y / 2;
      const int other_x = x < 0 ? x + f.plan.taps.x : x - f.plan.taps.x,
                other_y = y < 0 ? y + f.plan.taps.y : y - f.plan.taps.y;
      for (const glm::ivec2 way : {glm::ivec2(x, y), {other_x, y}, {x, other_y}, {other_x, other_y}}) {
        if (!f.isSame(p, p + way)) continue;
        sum += f.before[4 * f.at(p + way) + channel];
        weight += 1.0;
        break;
      }
    }
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

/// True where all rows of the window hold the pixel's surface above and below it: then each is cut by itself.
bool rowsStand(const Filtered& f, glm::ivec2 p) {
  for (int ky = 0; ky < f.plan.taps.y; ++ky)
    if (!f.isSame(p, p + glm::ivec2(0, ky - f.plan.taps.y / 2))) return false;
  return true;
}

/// Two passes, mended where a row is replaced.
double twoPasses(const Filtered& f, glm::ivec2 p, std::size_t channel) {
  if (!rowsStand(f, p)) return onePass(f, p, channel);
  double sum = 0.0, weight = 0.0;
  for (int ky = 0; ky < f.plan.taps.y; ++ky) {
    const glm::ivec2 q = p + glm::ivec2(0, ky - f.plan.taps.y / 2);
    for (int kx = 0; kx < f.plan.taps.x; ++kx) {
      const int x = wayTo(kx, f.plan.taps.x, [&](int way) { return f.isSame(q, q + glm::ivec2(way, 0)); });
      if (x == INT_MAX) continue;
      sum += f.before[4 * f.at(q + glm::ivec2(x, 0)) + channel];
      weight += 1.0;
    }
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

TEST(RadianceFilterTwin, FiltersAreTheSumsWrittenOut) {
  const Scene scene = loadScene("builtin:lamp?detail=0.3");  // thin bars, edges
  std::mt19937 random(7);
  std::vector<float> noise(std::size_t(kWidth * kHeight * 28));
  for (float& x : noise) x = float(random() % 1000) / 500.0f - 1.0f;
  for (const char* kind : {"one_pass", "two_pass"}) {
    const Filtered f = filter(scene, kind, [&](std::size_t pixel, int i) {
      return i == 27 ? 1.0f : noise[28 * pixel + std::size_t(i)];
    });
    int wrong = 0, covered = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const glm::ivec2 p(x, y);
        covered += f.ids[f.at(p)].x != 0;
        for (std::size_t c = 0; c < 4; ++c) {
          const double want = kind[0] == 'o' ? onePass(f, p, c) : twoPasses(f, p, c);
          wrong += std::abs(want - double(f.after[4 * f.at(p) + c])) > 4e-3;
        }
      }
    }
    EXPECT_GT(covered, kWidth * kHeight / 2);
    EXPECT_LE(wrong, kWidth * kHeight / 100) << kind;  // pairs at the very tolerance
  }
}

// RF-4: weights are normalised, so that a constant stays, at edges and on thin bars too.
TEST(RadianceFilterTwin, ConstantStaysAndBackgroundStaysEmpty) {
  for (const char* kind : {"one_pass", "two_pass"}) {
    const Filtered f = filter(loadScene("builtin:lamp?detail=0.3"), kind,
                              [](std::size_t, int i) { return i == 27 ? 1.0f : 0.7f; });
    for (std::size_t i = 0; i < f.ids.size(); ++i)
      ASSERT_NEAR(f.after[4 * i], f.ids[i].x == 0 ? 0.0f : 0.7f, 1.5e-3f) << kind << ' ' << i;
  }
}

// Beside edges a mean is carried back along the light's slope: light that changes evenly over a floor comes out as it went in, up to the
// edges of what stands on it, as long as whole windows stand further on.
TEST(RadianceFilterTwin, EvenSlopesStayBesideEdges) {
  const Scene scene = loadScene("builtin:shadow?detail=0.3");
  const auto ramp = [](std::size_t pixel) { return 0.3f + 0.01f * float(pixel % kWidth); };
  const float middle = -0.01f * 0.5f;  // of a whole window of four taps, past the pixel
  double flat = 0.0, followed = 0.0;
  for (const char* slopes : {"off", "on"}) {
    const Filtered f = filter(
        scene, "two_pass",
        [&](std::size_t pixel, int i) { return i == 27             ? 1.0f
                                               : (i < 3 || i == 8) ? ramp(pixel)
                                                                   : 0.0f; },
        slopes);
    double& squares = slopes[1] == 'n' ? followed : flat;
    for (std::size_t i = 0; i < f.ids.size(); ++i)
      if (f.ids[i].x == 1) squares += std::pow(double(f.after[4 * i] - ramp(i) - middle), 2.0);
  }
  EXPECT_GT(flat, 0.01);
  EXPECT_LT(followed, 0.5 * flat);
}

// The filter's two passes by the host and by the device, of odd sizes, windows with and without replaced taps.
TEST(RadianceFilterTwin, HostFiltersAsTheDeviceDoes) {
  if (!gpu::testDevice().info().software) GTEST_SKIP() << "the host filters for software drivers alone";
  const Scene scene = loadScene("builtin:lamp?detail=0.3");
  const PosedScene posed = pose(scene, 0.0f);
  for (const auto& [sets, window, mode, width, height] :
       {std::tuple("4", "1", "radiance", kWidth, kHeight),
        std::tuple("5", "1", "irradiance", kWidth, kHeight),
        std::tuple("8", "4", "radiance", kWidth, kHeight), std::tuple("4", "1", "radiance", 1, 3),
        std::tuple("4", "1", "radiance", 1, 5)}) {
    std::vector<float> filtered[2];
    for (const char* means : {"host", "device"}) {
      frame::TestFrame frame(scene);
      RadianceFilter technique(gpu::testDevice());
      Settings settings(info().options);
      for (const auto& [name, text] :
           {std::pair("sets", sets), std::pair("window", window), std::pair("mode", mode),
            std::pair("visibility", means), std::pair("direct", "3"), std::pair("indirect", "4")})
        settings.set(name, text);
      frame.draw(posed, posed.cameras.at(0), {.width = width, .height = height},
                 [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                   return technique.record(graph, inputs, settings);
                 });
      for (const char* what :
           {"irradiance_direct", "irradiance_indirect", "gloss_direct", "gloss_indirect"}) {
        const std::vector<float> values = frame.floats(fmt::format("radiance_filter.{}", what));
        filtered[means[0] == 'd'].insert(filtered[means[0] == 'd'].end(), values.begin(), values.end());
      }
    }
    double difference = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < filtered[0].size(); ++i) {
      if (i % 4 == 3) continue;
      difference += std::pow(double(filtered[0][i]) - double(filtered[1][i]), 2.0);
      squares += std::pow(double(filtered[1][i]), 2.0);
    }
    EXPECT_GT(squares, 0.1);
    EXPECT_LT(std::sqrt(difference / squares), 2e-3) << sets;  // pairs at the very tolerance
  }
}

// RF-3: the field of some pixels in doubles, from the rows and the answers of the rays; then RF-5 from what the filter left.
TEST(RadianceFilterTwin, FieldAndShadingAreTheirEquations) {
  const Scene scene = loadScene("builtin:cornell?detail=0.3");
  frame::TestFrame frame(scene);
  RadianceFilter technique(gpu::testDevice());
  const PosedScene posed = pose(scene, 0.0f);
  Settings settings(info().options);
  settings.set("sets", "2");
  settings.set("filter", "none");
  settings.set("beams", "off");
  settings.set("apart", "off");
  frame.draw(posed, posed.cameras.at(0), {.width = 40, .height = 30},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               return technique.record(graph, inputs, settings);
             });
  const auto points =
      frame.graph.findBuffer("radiance_filter.points").buffer().download<visibility::SightPoint>();
  const auto bits =
      frame.graph.findBuffer("radiance_filter.visibility_bits").buffer().download<std::uint32_t>();
  const auto exposure = frame.graph.findBuffer("radiance_filter.exposure").buffer().download<float>().at(0);
  const auto rows = frame.graph.findBuffer("vpls.walk_rows").buffer().download<vpls::WalkVpl>();
  const auto sets = frame.graph.findBuffer("vpls.walk_sets").buffer().download<visibility::SightSet>();
  const gpu::Image& values = frame.graph.find("radiance_filter.values_packed").image();
  std::vector<std::vector<float>> layers;
  for (int l = 0; l < kFieldLayers; ++l) layers.push_back(values.downloadFloats(0, l));
  const auto diffuse = frame.floats("radiance_filter.irradiance_direct");
  const auto packed = frame.graph.find("frame.normals_packed").image().download<glm::uvec2>();
  int looked_at = 0;
  for (std::size_t p = 0; p < points.size(); p += 37) {
    const visibility::SightPoint& point = points[p];
    if (point.normal == glm::vec3(0.0f)) continue;
    const std::size_t in_tile = p % 300, x = 2 * (in_tile % 20) + point.set % 2,
                      y = 2 * (in_tile / 20) + point.set / 2;
    const std::size_t pixel = y * 40 + x;
    sh::ShRgb sum(3), kept(3);
    for (int i = 0; i < 9; ++i) sum[i] = kept[i] = glm::vec3(0.0f);
    for (std::uint32_t k = 0; k < sets[point.set].count; ++k) {
      if ((bits[(k / 32) * points.size() + p] >> (k % 32) & 1u) == 0u) continue;
      const vpls::WalkVpl& row = rows[sets[point.set].first + k];
      glm::vec3 way = row.end.position, light = row.light;
      if (row.end.kind != visibility::kSightDirectional) {
        const glm::vec3 between = row.end.position - point.position;
        const float squared = glm::dot(between, between);
        way = between / std::sqrt(squared);
        const float cosine = std::max(0.0f, -glm::dot(way, row.end.normal)),
                    bound = settings.number("bound") * row.bound;
        ASSERT_EQ(row.end.kind, visibility::kSightSurface);
        light *= vpls::discCosine(cosine * std::sqrt(squared), squared, bound) / std::max(squared, bound);
      }
      const sh::Sh basis = sh::evaluate(3, way);
      for (int i = 0; i < 9; ++i) sum[i] += light * basis[i];
    }
    float largest = 0.0f;
    for (int i = 0; i < 9; ++i) largest = std::max(largest, glm::length(sum[i]));
    for (int i = 0; i < 27; ++i) {
      kept[i / 3][i % 3] = layers[std::size_t(i / 4)][4 * pixel + std::size_t(i % 4)] / exposure;
      ASSERT_NEAR(kept[i / 3][i % 3], sum[i / 3][i % 3], 2e-3f * largest + 1e-5f) << p << ' ' << i;
    }
    const glm::vec3 want = 3.14159265f * brdf::shadeLambert(kept, unpacked(packed[pixel].x));
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(diffuse[4 * pixel + std::size_t(c)], std::max(0.0f, want[c]), 2e-3f * largest + 1e-4f);
    ++looked_at;
  }
  EXPECT_GT(looked_at, 15);
}

}  // namespace
}  // namespace gloam::radiance_filter
