// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/renderer.h>
#include <gtest/gtest.h>

namespace gloam {
namespace {

std::vector<Option> options() {
  return {{.name = "order", .default_value = 3, .minimum = 2, .maximum = 6},
          {.name = "scale", .default_value = 0.5f, .minimum = 0.0, .maximum = 1.0},
          {.name = "window", .default_value = std::string("auto"), .choices = {"none", "auto"}},
          {.name = "indirect", .default_value = true}};
}

std::string errorOf(const std::string& name, const std::string& text) {
  Settings settings(options());
  try {
    settings.set(name, text);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Settings, DefaultsThenValues) {
  Settings settings(options());
  EXPECT_EQ(settings.integer("order"), 3);
  EXPECT_EQ(settings.number("scale"), 0.5f);
  EXPECT_EQ(settings.choice("window"), "auto");
  EXPECT_TRUE(settings.flag("indirect"));
  settings.set("order", "6");
  settings.set("scale", "0.25");
  settings.set("window", "none");
  settings.set("indirect", "off");
  EXPECT_EQ(settings.integer("order"), 6);
  EXPECT_EQ(settings.number("scale"), 0.25f);
  EXPECT_EQ(settings.choice("window"), "none");
  EXPECT_FALSE(settings.flag("indirect"));
  const std::vector<std::pair<std::string, std::string>> want = {
      {"order", "6"}, {"scale", "0.25"}, {"window", "none"}, {"indirect", "off"}};
  EXPECT_EQ(settings.list(), want);
}

// What list() says, set() takes.
TEST(Settings, ListCanBeSetAgain) {
  Settings settings(options()), copy(options());
  settings.set("scale", "0.1");
  settings.set("indirect", "no");
  for (const auto& [name, text] : settings.list()) copy.set(name, text);
  EXPECT_EQ(copy.list(), settings.list());
  EXPECT_EQ(copy.number("scale"), settings.number("scale"));
}

TEST(Settings, ErrorsNameOptionValueAndWhatWasExpected) {
  EXPECT_EQ(errorOf("order", "7"), "option 'order': '7' is not a whole number from 2 to 6");
  for (const char* text : {"", "3.5", "3 ", "three", "99999999999", "0x4"})
    EXPECT_NE(errorOf("order", text).find("is not a whole number from 2 to 6"), std::string::npos) << text;
  for (const char* text : {"-0.1", "1.1", "nan", "inf", "1e", ""})
    EXPECT_NE(errorOf("scale", text).find("is not a number from 0 to 1"), std::string::npos) << text;
  EXPECT_EQ(errorOf("window", "hamming"), "option 'window': 'hamming' is not one of none, auto");
  EXPECT_EQ(errorOf("indirect", "maybe"), "option 'indirect': 'maybe' is neither on nor off");
  EXPECT_EQ(errorOf("ordr", "3"), "option 'ordr': unknown; there are: order, scale, window, indirect");
  EXPECT_THROW(Settings().set("order", "3"), Error);
  EXPECT_THROW(Settings().integer("order"), Error);
}

}  // namespace
}  // namespace gloam
