// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/proxies/proxies.h"

#include "frame/test_frame.h"
#include "math/sampling.h"
#include "math/sh_log_exp.h"
#include "scene/environment.h"
#include "spheres/receiver_rule.h"
#include "techniques/proxies/proxies_tables.h"

namespace gloam::proxies {
namespace {

constexpr int kSize = 64;
constexpr float kPi = 3.14159265f;
using Values = std::vector<std::pair<std::string, std::string>>;

/// Images of one frame at full size, four floats a pixel (one for the last two).
struct Picture {
  std::vector<float> position, normal, direct, indirect, visibility, normalisation;
  std::size_t pixels() const { return position.size() / 4; }
  bool covered(std::size_t i) const { return position[4 * i + 3] > 0.0f; }
  glm::vec3 at(const std::vector<float>& image, std::size_t i) const {
    return {image[4 * i], image[4 * i + 1], image[4 * i + 2]};
  }
};

Picture draw(const Scene& scene, const PosedCamera& camera, const std::vector<frame::Proxy>& proxies,
             const Values& values = {}, const std::vector<frame::Patch>& flats = {}) {
  frame::TestFrame frame(scene);
  Proxies technique(gpu::testDevice());
  Settings settings(info().options);
  settings.set("divisor", "1");
  settings.set("window", "none");
  for (const auto& [name, value] : values) settings.set(name, value);
  const std::string level = settings.choice("divisor");
  frame.draw(pose(scene, 0.0f), camera, {.width = kSize, .height = kSize, .proxies = proxies, .flats = flats},
             [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
               return technique.record(graph, inputs, settings);
             });
  return {frame.floats("frame.receiver_position_" + level),
          frame.floats("frame.receiver_normal_" + level),
          frame.floats("proxies.direct"),
          frame.floats("proxies.indirect"),
          frame.floats("proxies.visibility"),
          frame.floats("proxies.normalisation")};
}

/// What the receiver gets by sums written out: the slow twin of the whole pipeline for one sphere, its blocker as the
/// projection itself, no logarithm.
glm::vec3 irradianceBehindOne(const ProxyLight& row, const glm::vec3& p, const glm::vec3& n,
                              const frame::Proxy& proxy) {
  const spheres::SeenSphere seen = spheres::seenSphere(p, n, proxy.center, proxy.radius, proxy.bulge);
  sh::Zh blocked = sh::discZonal(4, std::asin(seen.sin_half_angle));
  sh::Sh open = sh::rotateZonal(blocked, seen.direction);
  for (int i = 0; i < 16; ++i) open[i] = -open[i];
  open[0] += std::sqrt(4.0f * kPi);
  const sh::Sh y = sh::evaluate(3, n);
  float left = 0.0f;
  for (int i = 0; i < 16; ++i) left += open[i] * row.peak.basis[i];
  glm::vec3 sum =
      row.peak.irradiance * std::clamp(left, 0.0f, 1.0f) * std::max(0.0f, glm::dot(n, row.peak.direction));
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 9; ++j) sum += open[i] * row.shade[9 * i + j] * y[j];
  }
  return sum;
}

TEST(Proxies, OneSphereOverAPlaneIsTheProjectionOfItsShadow) {
  const Scene scene = frame::planeScene("preetham?elevation=40");
  const frame::Proxy sphere{{0.3f, 1.2f, -0.2f}, 0.7f, glm::vec3(0.5f)};
  const sh::ShRgb all_bands = projectEnvironment(scene.environment, 6), light = sh::truncated(all_bands, 4);
  const glm::vec3 open = sh::irradiance(light, {0, 1, 0});
  for (const char* parts : {"true", "false"}) {
    const Picture picture = draw(scene, frame::kAbove, {sphere}, {{"coverage", "all"}, {"parts", parts}});
    const ProxyLight row =
        parts[0] == 't' ? proxyLight(light, sh::lightParts(all_bands, 4)) : proxyLight(light);
    double wrong = 0.0, all = 0.0;
    float least = 1e9f;
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      const glm::vec3 got = picture.at(picture.direct, i);
      const glm::vec3 want =
          irradianceBehindOne(row, picture.at(picture.position, i), picture.at(picture.normal, i), sphere);
      wrong += double(glm::dot(got - want, got - want)), all += double(glm::dot(want, want));
      least = std::min(least, got.x / open.x);
    }
    EXPECT_LT(std::sqrt(wrong / all), 0.02) << parts;
    EXPECT_LT(least, 0.7f) << parts;  // there is a shadow
  }
}

// A white sun over a blue sky: what the sun's ringing lacks in the shadow at a ball's foot is not taken from the sky's red.
TEST(Proxies, ASunsShadowKeepsTheSkysColour) {
  Scene scene = frame::planeScene("gradient");
  scene.environment = loadEnvironment("sky:preetham?elevation=30");
  const std::vector<frame::Proxy> balls = {{{0, 1, 0}, 1.0f, glm::vec3(0.5f)},
                                           {{0, 2.5f, 0}, 1.0f, glm::vec3(0.5f)}};
  const auto least_red = [&](const char* parts) {
    const Picture picture = draw(scene, frame::kAbove, balls, {{"coverage", "all"}, {"parts", parts}});
    float least = 1e9f;
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      const glm::vec3 lit = picture.at(picture.direct, i);
      if (lit.z > 0.05f) least = std::min(least, lit.x / lit.z);
    }
    return least;
  };
  EXPECT_LT(least_red("false"), 0.05f);
  EXPECT_GT(least_red("true"), 0.2f);
}

// Under a white sky a white sphere sends to each receiver what it takes.
TEST(Proxies, OneWhiteSphereInTheWhiteFurnaceIsNotSeen) {
  Scene scene = frame::planeScene("uniform");
  const Picture empty = draw(scene, frame::kAbove, {});
  const frame::Proxy sphere{{0.0f, 1.5f, 0.0f}, 0.8f, glm::vec3(1.0f)};
  for (const char* kind : {"averaged", "point", "exact"}) {
    const Picture picture = draw(scene, frame::kAbove, {sphere}, {{"indirect", kind}, {"coverage", "all"}});
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      const float sum = picture.direct[4 * i] + picture.indirect[4 * i];
      ASSERT_NEAR(sum / empty.direct[4 * i], 1.0f, 0.02f) << kind;
    }
  }
}

TEST(Proxies, NormalisationOfOneSphereIsOne) {
  const Scene scene = frame::planeScene("uniform");
  for (const float height : {1.4f, 2.0f, 2.8f, 6.0f}) {  // sine 0.6 below the first
    const frame::Proxy sphere{{0.0f, height, 0.0f}, 0.84f, glm::vec3(0.5f)};
    const Picture picture = draw(scene, frame::kAbove, {sphere}, {{"coverage", "all"}});
    for (const float share : picture.normalisation) ASSERT_NEAR(share, 1.0f, 0.01f) << height;
  }
}

// Spheres that overlap many times over send back no more than they take together.
TEST(Proxies, OverlappingProxiesSendNoMoreThanTheyBlock) {
  const Scene scene = frame::planeScene("uniform");
  const frame::Proxy sphere{{0.0f, 2.0f, 0.0f}, 0.8f, glm::vec3(1.0f)};
  const Picture open = draw(scene, frame::kAbove, {});
  const Picture many =
      draw(scene, frame::kAbove, std::vector<frame::Proxy>(20, sphere), {{"coverage", "all"}});
  float most = 0.0f;
  for (std::size_t i = 0; i < open.pixels(); ++i) {
    const float sum = many.direct[4 * i] + many.indirect[4 * i];
    ASSERT_NEAR(sum / open.direct[4 * i], 1.0f, 0.2f);
    most = std::max(most, many.indirect[4 * i] / open.direct[4 * i]);
  }
  EXPECT_GT(most, 0.04f);
}

std::vector<frame::Proxy> crowd(int count) {
  std::vector<frame::Proxy> proxies;
  const std::vector<glm::vec3> ways = sampling::fibonacciSphere(count);
  for (int i = 0; i < count; ++i) {
    const glm::vec3 way = ways[std::size_t(i)];
    proxies.push_back({glm::vec3(3.5f * way.x, 0.5f + 0.3f * std::abs(way.y), 3.5f * way.z),
                       0.1f + 0.02f * float(i % 5), 0.5f + 0.5f * way});
  }
  return proxies;
}

TEST(Proxies, CoverageOracleChangesThePictureByAtMostFourOf256) {
  for (const char* sky : {"preetham?elevation=25", "gradient"}) {
    const Scene scene = frame::planeScene(sky);
    const Picture all = draw(scene, frame::kAbove, crowd(16), {{"coverage", "all"}});
    glm::vec3 open(0.0f);  // the brightest shade
    for (const glm::vec3& n : sampling::fibonacciSphere(500))
      open = glm::max(open, sh::irradiance(projectEnvironment(scene.environment, 3), n));
    for (const char* coverage : {"fixed", "light"}) {
      const Picture picture = draw(scene, frame::kAbove, crowd(16), {{"coverage", coverage}});
      for (std::size_t i = 0; i < all.direct.size(); ++i) {
        const float most = open[int(std::min(i % 4, std::size_t(2)))] * 4.0f / 256.0f;
        ASSERT_NEAR(picture.direct[i], all.direct[i], most) << sky << ' ' << coverage;
        ASSERT_NEAR(picture.indirect[i], all.indirect[i], most) << sky << ' ' << coverage;
      }
    }
  }
}

// Splats and lists of tiles are the same sum, from anywhere: above, from within the spheres of influence, and in parallel.
TEST(Proxies, SplatsAndTilesShowTheSamePicture) {
  const Scene scene = frame::planeScene("preetham?elevation=25");
  PosedCamera parallel = frame::cameraAt({1, 9, 4}, {0, 0, 0});
  parallel.camera.perspective = false;
  parallel.camera.half_height = 3.0f;
  const PosedCamera cameras[] = {frame::kAbove, frame::cameraAt({0.4f, 0.7f, 0.3f}, {-3, 0, 1}, 70),
                                 parallel};
  for (const char* coverage : {"fixed", "light", "all"}) {
    for (const PosedCamera& camera : cameras) {
      for (const char* divisor : {"1", "4"}) {
        const Values common = {{"coverage", coverage}, {"divisor", divisor}};
        Values splat = common;
        splat.emplace_back("accumulate", "splat");
        const Picture want = draw(scene, camera, crowd(40), common),
                      got = draw(scene, camera, crowd(40), splat);
        float brightest = 0.0f, least = INFINITY;
        for (const float value : want.direct) brightest = std::max(brightest, value);
        for (std::size_t i = 0; i < want.direct.size(); ++i) {
          ASSERT_NEAR(got.direct[i], want.direct[i], 2e-3f * brightest) << coverage << ' ' << divisor;
          ASSERT_NEAR(got.indirect[i], want.indirect[i], 2e-3f * brightest) << coverage << ' ' << divisor;
        }
        for (const float value : got.visibility) least = value > 0.0f ? std::min(least, value) : least;
        ASSERT_LT(least, 0.97f) << "there are shadows";
      }
    }
  }
}

TEST(Proxies, SplatsOfNothingAndWithoutIndirectLight) {
  const Scene scene = frame::planeScene("uniform");
  const Picture open = draw(scene, frame::kAbove, {}),
                none = draw(scene, frame::kAbove, {}, {{"accumulate", "splat"}});
  EXPECT_EQ(open.direct, none.direct);
  const Picture tiles = draw(scene, frame::kAbove, crowd(8), {{"indirect", "off"}});
  const Picture splat = draw(scene, frame::kAbove, crowd(8), {{"indirect", "off"}, {"accumulate", "splat"}});
  for (std::size_t i = 0; i < tiles.direct.size(); ++i) ASSERT_NEAR(splat.direct[i], tiles.direct[i], 2e-3f);
  for (std::size_t i = 0; i < splat.indirect.size(); i += 4) ASSERT_EQ(splat.indirect[i], 0.0f);
}

/// Irradiance from an unshadowed white sphere, by directions: the slow twin of all three operators.
glm::vec3 irradianceFromOne(const sh::ShRgb& light, const glm::vec3& p, const glm::vec3& n,
                            const frame::Proxy& ball) {
  constexpr int kWays = 4000;
  const glm::vec3 d = ball.center - p;
  const float distance = glm::length(d),
              cosine = std::sqrt(1.0f - ball.radius * ball.radius / (distance * distance));
  const glm::vec3 axis = d / distance, t = glm::normalize(glm::cross(axis, glm::vec3(1, 0.2f, 0))),
                  b = glm::cross(axis, t);
  glm::vec3 sum(0.0f);
  for (int i = 0; i < kWays; ++i) {
    const glm::vec2 u = sampling::r2(std::uint32_t(i));
    const float z = 1.0f - u.x * (1.0f - cosine), side = std::sqrt(1.0f - z * z), angle = 2.0f * kPi * u.y;
    const glm::vec3 s = z * axis + side * (std::cos(angle) * t + std::sin(angle) * b);
    const float along = glm::dot(s, d);
    const float hit =
        along - std::sqrt(std::max(0.0f, along * along - distance * distance + ball.radius * ball.radius));
    const glm::vec3 normal = (p + hit * s - ball.center) / ball.radius;
    sum += sh::irradiance(light, normal) / kPi * std::max(0.0f, glm::dot(n, s));
  }
  return sum * (2.0f * kPi * (1.0f - cosine) / float(kWays));
}

// What a sphere sends to a plane: all light that leaves towards it, summed by directions. What differs are three bands of the cosine
// and the disc; and of the point-sampled operator that the side towards the plane is not all of what is seen.
TEST(Proxies, OperatorsAgreeWithTheSumOverDirections) {
  const Scene scene = frame::planeScene("preetham?elevation=40");
  const frame::Proxy ball{{0.3f, 1.6f, -0.2f}, 0.8f, glm::vec3(1.0f)};
  const sh::ShRgb light = sh::truncated(projectEnvironment(scene.environment, 6), 4);
  const auto error = [&](const char* kind) {
    const Picture picture = draw(scene, frame::kAbove, {ball}, {{"indirect", kind}, {"coverage", "all"}});
    double wrong = 0.0, all = 0.0;
    for (std::size_t i = 0; i < picture.pixels(); i += 7) {
      const glm::vec3 want =
          irradianceFromOne(light, picture.at(picture.position, i), picture.at(picture.normal, i), ball);
      const glm::vec3 d = picture.at(picture.indirect, i) - want;
      wrong += double(glm::dot(d, d)), all += double(glm::dot(want, want));
    }
    return wrong / all;
  };
  const double exact = error("exact"), averaged = error("averaged"), point = error("point");
  EXPECT_LT(exact, 0.002);
  EXPECT_LT(averaged, 0.012);
  EXPECT_LT(averaged, 0.25 * point);
}

// A ball that one sphere stands for, exactly or a little too large, is lit as if nothing stood for it.
TEST(Proxies, WellFittedSphereDoesNotBlackenItself) {
  SceneBuilder builder("ball");
  builder.place("ball", shapes::icosphere(1.0f, 24), builder.diffuse("white", glm::vec3(0.8f)));
  builder.sky("preetham?elevation=40");
  const Scene scene = builder.finish();
  const PosedCamera camera = frame::cameraAt({1, 2, 5}, {0, 0, 0}, 28);
  const Picture open = draw(scene, camera, {});
  float brightest = 0.0f;
  for (std::size_t i = 0; i < open.pixels(); ++i) brightest = std::max(brightest, open.direct[4 * i + 1]);
  for (const float radius : {0.99f, 1.0f, 1.03f}) {
    const Picture picture = draw(scene, camera, {{glm::vec3(0.0f), radius, glm::vec3(0.8f)}});
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      if (picture.covered(i)) {
        ASSERT_NEAR(picture.direct[4 * i + 1], open.direct[4 * i + 1], 0.05f * brightest) << radius;
      }
    }
  }
}

TEST(Proxies, ExponentialsAgree) {
  const Scene scene = frame::planeScene("preetham?elevation=40");
  const Picture want = draw(scene, frame::kAbove, crowd(40));
  const auto worst = [&](const char* name) {
    const Picture got = draw(scene, frame::kAbove, crowd(40), {{"exponential", name}});
    float difference = 0.0f, brightest = 0.0f;
    for (std::size_t i = 0; i < want.direct.size(); ++i) {
      if (i % 4 == 3) continue;
      difference = std::max(difference, std::abs(got.direct[i] - want.direct[i]));
      brightest = std::max(brightest, want.direct[i]);
    }
    return difference / brightest;
  };
  EXPECT_LT(worst("hyb"), 0.02f);
  EXPECT_LT(worst("ps"), 0.02f);
  EXPECT_LT(worst("ol"), 0.15f);
}

TEST(Proxies, ManyProxiesAndTheSamePictureTwice) {
  const Scene scene = frame::planeScene("gradient");
  const Picture first = draw(scene, frame::kAbove, crowd(2000)),
                second = draw(scene, frame::kAbove, crowd(2000));
  EXPECT_EQ(first.direct, second.direct);
  EXPECT_EQ(first.indirect, second.indirect);
  for (const float value : first.direct) ASSERT_TRUE(std::isfinite(value) && value >= 0.0f);
  for (const float value : first.indirect) ASSERT_TRUE(std::isfinite(value) && value >= 0.0f);
}

/// Direct light of all pixels, at full size whatever the receivers' is.
std::vector<float> lightOfPixels(const Scene& scene, const PosedCamera& camera,
                                 const std::vector<frame::Proxy>& proxies, const Values& values) {
  frame::TestFrame frame(scene);
  Proxies technique(gpu::testDevice());
  Settings settings(info().options);
  for (const auto& [name, value] : values) settings.set(name, value);
  const frame::FrameImages images =
      frame.draw(pose(scene, 0.0f), camera, {.width = 128, .height = 128, .proxies = proxies},
                 [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                   return technique.record(graph, inputs, settings);
                 });
  return images.direct.image().downloadFloats();
}

double relativeError(const std::vector<float>& got, const std::vector<float>& want) {
  double wrong = 0.0, all = 0.0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (i % 4 == 3) continue;
    wrong += double(got[i] - want[i]) * double(got[i] - want[i]), all += double(want[i]) * double(want[i]);
  }
  return std::sqrt(wrong / all);
}

// On one plane, however slanted, all four receivers count: the same picture as by bilinear weights, no bands.
TEST(Proxies, SlantedGroundIsUpsampledAsSmoothlyAsAPicture) {
  const Scene scene = frame::planeScene("preetham?elevation=40");
  const std::vector<frame::Proxy> proxies = {{{0.0f, 0.5f, 0.5f}, 0.4f, glm::vec3(0.5f)}};
  PosedCamera parallel = frame::cameraAt({0, 0.8f, 3}, {0, 0, 1});
  parallel.camera.perspective = false;
  parallel.camera.half_height = 0.6f;
  for (const PosedCamera& camera : {frame::cameraAt({0, 0.8f, 3}, {0, 0, 1}, 30), parallel}) {
    for (const char* divisor : {"4", "8"}) {
      const Values plain = {{"divisor", divisor}, {"upsample", "bilinear"}},
                   along = {{"divisor", divisor}, {"upsample", "shaded"}};
      const std::vector<float> want = lightOfPixels(scene, camera, proxies, plain);
      EXPECT_LT(relativeError(lightOfPixels(scene, camera, proxies, along), want), 5e-4) << divisor;
    }
  }
}

// Coarse receivers brought to pixels agree with a receiver a pixel, silhouettes and contact included.
TEST(Proxies, CoarseReceiversShowTheSamePicture) {
  SceneBuilder builder("balls");
  const int grey = builder.diffuse("grey", glm::vec3(0.6f));
  builder.place("ground", shapes::ground(20, 20, 1, 1), grey);
  builder.place("ball", shapes::icosphere(1.0f, 16), grey, {0, 1, 0});
  builder.place("pole", shapes::cylinder(0.06f, 3.0f, 0.02f, 16, 4), grey, {1.6f, 0, 0.5f});
  builder.sky("preetham?elevation=40");
  const Scene scene = builder.finish();
  const PosedCamera camera = frame::cameraAt({3, 4, 7}, {0, 1, 0}, 35);
  const std::vector<frame::Proxy> proxies = {{{0, 1, 0}, 1.0f, glm::vec3(0.6f)}};
  const auto colors = [&](const Values& values) { return lightOfPixels(scene, camera, proxies, values); };
  const std::vector<float> want = colors({{"divisor", "1"}});
  const auto error = [&](const char* divisor, const char* way) {
    return relativeError(colors({{"divisor", divisor}, {"upsample", way}}), want);
  };
  const double field = error("4", "field"), shaded = error("4", "shaded"), bilinear = error("4", "bilinear");
  EXPECT_LT(field, 0.01);
  EXPECT_LT(error("4", "normal"), 0.012);
  EXPECT_LT(error("8", "field"), 0.024);  // of a picture of 16 x 16 receivers
  EXPECT_LT(shaded, 0.05);
  EXPECT_LT(field, shaded);
  EXPECT_LT(shaded, bilinear);
}

// Below the middle of a ceiling 4 wide, 2 high, what is left of a white sky is 1 less the form factor, 0.446; and a ground does not
// stand in its own light.
TEST(Proxies, ACeilingTakesItsFormFactorFromTheSky) {
  const Scene scene = frame::planeScene("uniform");
  const frame::Patch ceiling{{0, 2, 0}, {2, 0, 0}, {0, 0, 2}, {0, -1, 0}},
      ground{{0, 0, 0}, {10, 0, 0}, {0, 0, -10}, {0, 1, 0}};
  const Picture open = draw(scene, frame::kAbove, {}),
                grounded = draw(scene, frame::kAbove, {}, {}, {ground});
  EXPECT_EQ(open.direct, grounded.direct);
  const Picture under = draw(scene, frame::kAbove, {}, {}, {ground, ceiling});
  const Picture off = draw(scene, frame::kAbove, {}, {{"flats", "false"}}, {ground, ceiling});
  EXPECT_EQ(open.direct, off.direct);
  int middle = 0;
  for (std::size_t i = 0; i < under.pixels(); ++i) {
    const glm::vec3 p = under.at(under.position, i);
    EXPECT_LE(under.direct[4 * i], 1.01f * open.direct[4 * i]);
    if (std::hypot(p.x, p.z) > 0.15f) continue;
    EXPECT_NEAR(under.direct[4 * i] / open.direct[4 * i], 0.446f, 0.03f);
    ++middle;
  }
  EXPECT_GT(middle, 0);
}

TEST(Proxies, WithoutProxiesItIsUnshadowedAndWithoutLightDark) {
  Scene scene = frame::planeScene("preetham?elevation=40");
  const Picture picture = draw(scene, frame::kAbove, {}, {{"parts", "false"}});
  const glm::vec3 want = sh::irradiance(projectEnvironment(scene.environment, 4), {0, 1, 0});
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(picture.direct[4 * i + std::size_t(c)], want[c], 0.002f * want[c]);
    ASSERT_EQ(picture.indirect[4 * i], 0.0f);
  }
  scene.environment = {};
  frame::TestFrame frame(scene);
  Proxies technique(gpu::testDevice());
  const frame::FrameImages images =
      frame.draw(pose(scene, 0.0f), frame::kAbove, {.width = 8, .height = 8},
                 [&](gpu::FrameGraph& graph, const frame::FrameInputs& inputs) {
                   return technique.record(graph, inputs, Settings(info().options));
                 });
  for (const float value : images.direct.image().downloadFloats())
    ASSERT_TRUE(value == 0.0f || value == 1.0f);
}

}  // namespace
}  // namespace gloam::proxies
