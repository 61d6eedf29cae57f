// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Pictures that a test expects. Link gloam_test_support.
#pragma once

#include <gloam/image.h>

#include <string>

namespace gloam::test {

/// How far a picture may be from the expected one, in 8-bit steps after sRGB encoding.
struct GoldenTolerance {
  int max_difference = 2;         ///< of any pixel and channel
  double share_differing = 0.01;  ///< of the pixels that may differ by more than one step at all
};

/// Compares a picture (linear 0 to 1, as writePng takes it, at most 128 x 128) with tests/golden/NAME.png. Returns
/// an empty text where it agrees, else one line that says by how much it does not and where got.png, want.png and
/// diff.png (differences times 16) lie: in golden/NAME/ of the build folder.
///   EXPECT_EQ(compareWithGolden(picture, "cornell_irradiance", {.max_difference = 3}), "");
/// With GLOAM_UPDATE_GOLDEN=1 in the environment it writes tests/golden/NAME.png instead and agrees.
std::string compareWithGolden(const Image& picture, const std::string& name,
                              const GoldenTolerance& tolerance = {});

/// The same against any folder; failures go to `failures`.
std::string compareWithGolden(const Image& picture, const std::string& name, const GoldenTolerance& tolerance,
                              const std::filesystem::path& goldens, const std::filesystem::path& failures);

}  // namespace gloam::test
