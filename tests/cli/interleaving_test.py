# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""radiance_filter at 8 x 8 sets, where normals are fine: how far it leads the classical filters, and how near it comes to 64 times
the rays."""
import unittest

from harness import CliTest

LEAST_LEAD = 6.0  # dB over the better classical filter by the same virtual lights
MOST_OVER_BRUTE = 1.5  # its error over that of every set at every pixel
SMALL = ["--env", "none", "--size", "120x90"]


class InterleavingTest(CliTest):
    def draw(self, scene, mode):
        self.succeed("render", scene, *SMALL, "--technique", "radiance_filter", "--radiance_filter.sets", "8",
                     "--radiance_filter.mode", mode, "-o", f"{mode}.exr")
        return f"{mode}.exr"

    def against(self, picture, reference, *options):
        return self.succeed_json("diff", picture, reference, *options)

    def check(self, scene):
        drawn = {mode: self.draw(scene, mode)
                 for mode in ("brute_exact", "brute", "radiance", "irradiance", "irradiance_normals")}
        psnr = {mode: self.against(drawn[mode], drawn["brute_exact"])["psnr"]
                for mode in ("radiance", "irradiance", "irradiance_normals")}
        self.assertGreater(psnr["radiance"], max(psnr["irradiance"], psnr["irradiance_normals"]) + LEAST_LEAD, psnr)
        self.succeed("reference", scene, *SMALL, "--bounces", "1", "--spp", "256", "--parts", "-o", "traced.exr")
        error = {mode: self.against(drawn[mode], "traced.exr", "--foreground")["relative_rmse"]
                 for mode in ("radiance", "brute")}
        self.assertLess(error["radiance"], MOST_OVER_BRUTE * error["brute"], error)

    def test_three_lamps_on_bumps(self):
        self.check("builtin:bumps")

    def test_two_panels_over_a_wet_floor(self):
        self.check("builtin:wet_floor")


if __name__ == "__main__":
    unittest.main()
