// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "file_names.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace gloam::view {
namespace {

TEST(FileNames, FreeOnesAreNumbered) {
  const auto folder = std::filesystem::temp_directory_path() / "gloam_file_names_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::string wanted = (folder / "a.b.png").string();
  EXPECT_EQ(freeName(wanted), wanted);
  for (const char* next : {"a.b_2.png", "a.b_3.png"}) {
    std::ofstream(freeName(wanted)) << "x";
    EXPECT_EQ(freeName(wanted), (folder / next).string());
  }
  std::filesystem::remove_all(folder);
  EXPECT_EQ(freeName("no_such_file.json"), "no_such_file.json");
}

TEST(FileNames, FilesAreFoundFromAnywhere) {
  for (const char* same : {"", "none", "sky:noon", "builtin:cornell?detail=0.25"})
    EXPECT_EQ(wholeName(same), same);
  EXPECT_EQ(wholeName("a/../b.glb"), (std::filesystem::current_path() / "b.glb").string());
  EXPECT_EQ(wholeName("/x/b.glb"), "/x/b.glb");
}

}  // namespace
}  // namespace gloam::view
