// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Parts of the light out of one reference picture.
#include <gloam/reference.h>
#include <gtest/gtest.h>

#include <functional>

#include "scene/builtin_scenes.h"

namespace gloam {
namespace {

/// All three kinds of light, both paths.
struct Lit {
  Scene scene = makeBuiltinScene("cornell?detail=0.25");
  PosedScene posed;
  Environment environment = loadEnvironment("sky:mild");
  PosedCamera camera;
  ReferenceOptions options{.width = 24, .height = 16, .bounces = 2};
  Lit() {
    posed = pose(scene, 0.0f);
    camera = posed.cameras.empty() ? framingCamera(posed, 1.5f) : posed.cameras.front();
    scene.materials[0].emission = glm::vec3(0.5f, 1.0f, 0.25f);
    PosedLight lamp;
    lamp.position = 0.5f * (posed.bounds_min + posed.bounds_max);
    posed.lights.push_back(lamp);
  }
  LayeredImage render(const Coverage& light, bool parts, int samples = 64) {
    options.light = light;
    return renderReference(scene, posed, camera, environment, options, {.samples = samples}, parts);
  }
};

std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

double meanOf(const LayeredImage& image, const std::string& layer) {
  const Image light = image.image(layer, {"R", "G", "B"}, layer);
  double sum = 0.0;
  for (const float value : light.pixels) sum += double(value);
  return sum / double(light.pixels.size());
}

const std::vector<Coverage> kParts{
    {.environment_direct = true},
    {.environment_direct = true, .environment_indirect = true},
    {.local_direct = true, .local_indirect = true},
    {.emitter_direct = true},
    {.local_direct = true, .emitter_direct = true, .emitter_indirect = true},
    {},
    kAllLight,
};

// Expectations are the same light, numbers are not: samples choose among the sources that are followed. The difference of
// two pictures of 64 samples is held against what both say of their noise.
TEST(ReferenceFile, PartsAreWhatARunOfThatLightAloneGives) {
  Lit lit;
  const LayeredImage file = lit.render(kAllLight, true);
  for (const Coverage& part : kParts) {
    const LayeredImage taken = imageOf(file, part, "all.exr");
    const LayeredImage alone = lit.render(part, false);
    EXPECT_EQ(coverageOf(taken, "").environment_direct, part.environment_direct);
    EXPECT_EQ(taken.attributes.at("gloam.light"), alone.attributes.at("gloam.light"));
    EXPECT_EQ(taken.attributes.at("gloam.sources"), alone.attributes.at("gloam.sources"));
    double variance = 0.0;
    const Image of_alone = alone.image("variance", {"R", "G", "B"}, ""),
                of_all = file.image("variance", {"R", "G", "B"}, "");
    for (std::size_t i = 0; i < of_all.pixels.size(); ++i)
      variance += double(of_alone.pixels[i] + of_all.pixels[i]);
    const double standard_error = std::sqrt(variance) / double(of_all.pixels.size());
    EXPECT_NEAR(meanOf(taken, ""), meanOf(alone, ""), 4.0 * standard_error + 1e-5);
    EXPECT_NEAR(meanOf(taken, "direct") + meanOf(taken, "indirect"), meanOf(taken, ""), 1e-4);
    if (!part.environment_indirect && !part.local_indirect && !part.emitter_indirect) {
      EXPECT_EQ(meanOf(taken, "indirect"), 0.0);
    }
    EXPECT_NE(taken.find("depth"), nullptr);
    EXPECT_EQ(taken.find("variance"), nullptr);
  }
}

TEST(ReferenceFile, PartsAddUpAndAgreeWithTheTracersOwn) {
  Lit lit;
  PathTracer tracer(lit.scene, lit.posed, lit.camera, lit.environment, lit.options);
  tracer.refine(8);
  const LayeredImage file = tracer.imageWithParts();
  double sum = 0.0;
  for (const char* name :
       {"environment_direct", "environment_indirect", "local_direct", "local_indirect", "emitter_direct",
        "emitter_indirect", "environment_indirect_2", "local_indirect_2", "emitter_indirect_2", "seen"}) {
    EXPECT_GT(meanOf(file, name), 0.0) << name;
    sum += meanOf(file, name);
  }
  EXPECT_NEAR(sum, meanOf(file, ""), 1e-5 * sum);
  for (const Coverage& part : kParts) {
    const LayeredImage taken = imageOf(file, part, ""), own = tracer.image(part);
    for (const char* layer : {"", "direct", "indirect"}) {
      const Image a = taken.image(layer, {"R", "G", "B"}, ""), b = own.image(layer, {"R", "G", "B"}, "");
      for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        EXPECT_NEAR(a.pixels[i], b.pixels[i], 1e-5f * std::max(1.0f, b.pixels[i]));
      }
    }
  }
}

// Samples of a path do not know how many follow: up to two bounces of a picture of five are those of one of two, to the bit.
TEST(ReferenceFile, LightOfFewerBouncesIsWhatARunOfSoManyGives) {
  Lit lit;
  lit.options.bounces = 5;
  const LayeredImage file = lit.render(kAllLight, true, 8);
  for (const char* name : {"environment_indirect_2", "local_indirect_3", "emitter_indirect_4"})
    EXPECT_GT(meanOf(file, name), 0.0) << name;
  double last = -1.0;
  for (const int bounces : {0, 1, 2, 3}) {
    lit.options.bounces = bounces;
    const LayeredImage taken = imageOf(file, kAllLight, "five.exr", bounces);
    const LayeredImage alone = lit.render(kAllLight, false, 8);
    EXPECT_EQ(taken.attributes.at("gloam.bounces"), std::to_string(bounces));
    const Image a = taken.image("", {"R", "G", "B"}, ""), b = alone.image("", {"R", "G", "B"}, "");
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      EXPECT_NEAR(a.pixels[i], b.pixels[i], 1e-5f * std::max(1.0f, b.pixels[i])) << bounces;
    EXPECT_GT(meanOf(taken, "indirect"), last);
    last = meanOf(taken, "indirect") - 1e-9;
    EXPECT_TRUE(varianceOf(file, kAllLight, "", bounces).has_value());
  }
  const std::string error = errorOf([&] { imageOf(file, kAllLight, "five.exr", 4); });
  EXPECT_NE(error.find("five.exr: holds light of 4 bounces and more in one sum"), std::string::npos) << error;
  EXPECT_FALSE(varianceOf(file, kAllLight, "", 4).has_value());
  EXPECT_EQ(imageOf(file, kAllLight, "", 5).find("")->pixels, file.find("")->pixels);
  EXPECT_EQ(imageOf(file, kAllLight, "", 9).find("indirect")->pixels, file.find("indirect")->pixels);
}

// As earlier revisions wrote them.
TEST(ReferenceFile, PartsWhoseBouncesAreOneSumGiveThatSumAlone) {
  Lit lit;
  LayeredImage file = lit.render(kAllLight, true, 4);
  const LayeredImage whole = imageOf(file, kParts[1], "");
  Layer* sum = nullptr;
  for (Layer& layer : file.layers) {
    if (layer.name == "environment_indirect") sum = &layer;
  }
  ASSERT_NE(sum, nullptr);
  for (std::size_t i = 0; i < sum->pixels.size(); ++i)
    sum->pixels[i] += file.find("environment_indirect_2")->pixels[i];
  std::erase_if(file.layers, [](const Layer& layer) { return layer.name.ends_with("_2"); });
  EXPECT_NEAR(meanOf(imageOf(file, kParts[1], ""), ""), meanOf(whole, ""), 1e-5);
  EXPECT_EQ(meanOf(imageOf(file, kAllLight, "", 0), "indirect"), 0.0);
  const std::string error = errorOf([&] { imageOf(file, kAllLight, "old.exr", 1); });
  EXPECT_NE(error.find("old.exr: holds light of 1 bounces and more in one sum"), std::string::npos) << error;
}

TEST(ReferenceFile, AFileWithoutPartsGivesWhatNeedsNone) {
  Lit lit;
  lit.scene.materials[0].emission = glm::vec3(0.0f);
  for (Material& material : lit.scene.materials) material.emission = glm::vec3(0.0f);
  lit.posed.lights.clear();
  const LayeredImage file = lit.render(kAllLight, false, 8);
  EXPECT_EQ(file.attributes.at("gloam.sources"), "environment_direct environment_indirect");
  // The environment is all the light that there is.
  const Coverage environment{.environment_direct = true, .environment_indirect = true};
  EXPECT_EQ(imageOf(file, environment, "").find("")->pixels, file.find("")->pixels);
  const Coverage direct{.environment_direct = true};
  const LayeredImage taken = imageOf(file, direct, "");
  EXPECT_EQ(taken.find("direct")->pixels, file.find("direct")->pixels);
  EXPECT_EQ(meanOf(taken, "indirect"), 0.0);
  EXPECT_NEAR(meanOf(taken, ""), meanOf(file, "direct"), 1e-5);
  const std::string error = errorOf([&] { imageOf(file, {.environment_indirect = true}, "a.exr"); });
  EXPECT_NE(error.find("a.exr: holds"), std::string::npos) << error;
  EXPECT_NE(error.find("--parts"), std::string::npos) << error;
}

// Many pictures' spread against what each says of itself, part by part; halves of samples are less even than all of them.
TEST(ReferenceFile, SaysWhatTheNoiseOfAPartIs) {
  Lit lit;
  constexpr int kPictures = 40;
  std::vector<double> claimed(kParts.size(), 0.0), spread(kParts.size(), 0.0);
  std::vector<std::vector<double>> sums(kParts.size()), squares(kParts.size());
  for (int picture = 0; picture < kPictures; ++picture) {
    lit.options.seed = std::uint64_t(picture);
    const LayeredImage file =
        lit.render(kAllLight, true, 24);  // half as many again since halves were compared
    for (std::size_t k = 0; k < kParts.size(); ++k) {
      claimed[k] += *varianceOf(file, kParts[k], "") / kPictures;
      const Image light = imageOf(file, kParts[k], "").image("", {"R", "G", "B"}, "");
      sums[k].resize(light.pixels.size()), squares[k].resize(light.pixels.size());
      for (std::size_t i = 0; i < light.pixels.size(); ++i) {
        sums[k][i] += double(light.pixels[i]);
        squares[k][i] += double(light.pixels[i]) * double(light.pixels[i]);
      }
    }
    if (picture > 0) continue;
    const double noise = std::stod(file.attributes.at("gloam.noise"));
    const double reflected = meanOf(file, "") - meanOf(file, "seen");
    EXPECT_NEAR(std::sqrt(*varianceOf(file, kAllLight, "")), noise * reflected, 1e-3 * noise);
    EXPECT_NEAR(std::stod(file.attributes.at("gloam.variance")), *varianceOf(file, kAllLight, ""),
                1e-4 * noise);
  }
  for (std::size_t k = 0; k < kParts.size(); ++k) {
    for (std::size_t i = 0; i < sums[k].size(); ++i) {
      const double mean = sums[k][i] / kPictures;
      spread[k] += std::max(squares[k][i] / kPictures - mean * mean, 0.0) * kPictures / (kPictures - 1);
    }
    spread[k] /= double(sums[k].size());
    EXPECT_LT(spread[k], 1.2 * claimed[k] + 1e-8) << k;
    EXPECT_GT(spread[k], 0.35 * claimed[k] - 1e-8) << k;
  }
}

TEST(ReferenceFile, NoiseOfAPartIsNotGuessed) {
  Lit lit;
  const LayeredImage whole = lit.render(kAllLight, false, 4);
  EXPECT_TRUE(varianceOf(whole, kAllLight, "").has_value());
  EXPECT_FALSE(varianceOf(whole, kParts[1], "").has_value());
  EXPECT_FALSE(varianceOf(whole, kAllLight, "", 1).has_value());
  EXPECT_FALSE(varianceOf(lit.render(kAllLight, true, 1), kAllLight, "").has_value());
  LayeredImage file = lit.render(kAllLight, true, 4);
  for (const char* damaged : {"environment_direct", "environment_direct x", "moonlight 1", "seen 1 seen 1",
                              "seen nan", "environment_direct 1 seen 0"}) {
    file.attributes["gloam.part_variance"] = damaged;
    const std::string error = errorOf([&] { varianceOf(file, kAllLight, "a.exr"); });
    EXPECT_NE(error.find("a.exr: attribute gloam.part_variance"), std::string::npos) << damaged << error;
  }
}

TEST(ReferenceFile, SurvivesTheDisk) {
  Lit lit;
  const LayeredImage file = lit.render(kAllLight, true, 4);
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "gloam_reference_file_test.exr";
  writeExr(file, path);
  const LayeredImage back = readExr(path);
  std::filesystem::remove(path);
  EXPECT_EQ(back.attributes, file.attributes);
  for (const Layer& layer : file.layers) {
    ASSERT_NE(back.find(layer.name), nullptr) << layer.name;
    if (layer.type == ChannelType::kFloat) {
      EXPECT_EQ(back.find(layer.name)->pixels, layer.pixels) << layer.name;
    }
    EXPECT_EQ(back.find(layer.name)->ids, layer.ids) << layer.name;
  }
}

TEST(ReferenceFile, WhatIsMissingIsNamed) {
  Lit lit;
  const Coverage environment{.environment_direct = true, .environment_indirect = true};
  LayeredImage file = lit.render(environment, true, 4);
  const auto error = [&](const Coverage& part) { return errorOf([&] { imageOf(file, part, "r.exr"); }); };
  EXPECT_NE(error(kAllLight).find("r.exr: holds environment_direct environment_indirect; "),
            std::string::npos);
  const LayeredImage whole = file;
  file = lit.render(kAllLight, true, 4);
  std::erase_if(file.layers, [](const Layer& layer) { return layer.name == "environment_indirect"; });
  EXPECT_NE(error(environment).find("environment_indirect.R is missing"), std::string::npos);
  EXPECT_EQ(error({.environment_direct = true}), "");
  file = whole;
  std::erase_if(file.layers, [](const Layer& layer) { return layer.name == "direct"; });
  EXPECT_NE(error(environment).find("direct.R is missing"), std::string::npos) << error(environment);
  file = whole;
  file.attributes["gloam.light"] = "moonshine";
  EXPECT_NE(error(environment).find("'moonshine'"), std::string::npos);
  file.attributes.erase("gloam.light");
  EXPECT_NE(error(environment).find("is no picture by gloam reference"), std::string::npos);
  EXPECT_THROW(coverageOf({}, "r.exr"), Error);
}

}  // namespace
}  // namespace gloam
