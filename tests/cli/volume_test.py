# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""Smoke and cloud: baked, drawn, told of, and left out where nobody knows them."""
import subprocess
import time
import unittest

from harness import GLOAM, SMALL, CliTest

QUICK = ["--directions", "256", "--bounce-directions", "64", "--order", "3", "--bounces", "1"]
SCENE = "builtin:cloud?detail=0.25"


class Volume(CliTest):
    def test_a_cloud_is_baked_told_of_and_drawn(self):
        result = self.succeed_json("bake", SCENE, *QUICK, "--scatterings", "3", "--half", "-o", "a.glb")["volumes"]
        self.assertEqual((result["volumes"], result["scatterings"]), (1, 3))
        self.assertTrue(100 < result["filled_voxels"] < 1920, result)
        self.assertTrue(0 < result["last_order"] < 1, result)
        told = self.succeed_json("info", "a.glb")["volumes"]
        self.assertEqual(told[0]["size"], "16x10x12")
        self.assertEqual(told[0]["transfer"], {"order": 3, "scatterings": 3})
        self.succeed("render", "a.glb", *SMALL, "-o", "a.exr")
        once = self.means("a.exr", "direct")["G"], self.means("a.exr", "indirect")["G"]
        self.succeed("bake", SCENE, *QUICK, "--scatterings", "1", "-o", "b.glb")
        self.succeed("render", "b.glb", *SMALL, "-o", "b.exr")
        self.assertGreater(once[1], 1.2 * self.means("b.exr", "indirect")["G"])
        self.assertIn("volume left out", self.succeed("render", "a.glb", *SMALL, "--technique", "irradiance", "-o", "c.png").err)

    def test_a_finished_volume_is_kept(self):
        command = ["bake", SCENE, "--order", "5", "--directions", "65536", "--kind", "ds", "--scatterings", "2"]
        process = subprocess.Popen([GLOAM, *command, "-o", "a.glb"], cwd=self.folder, env=self.environment, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 60
        while not self.path("a.glb.checkpoint.volumes").exists() and process.poll() is None and time.monotonic() < end:
            time.sleep(0.005)
        process.kill()
        process.wait()
        self.assertFalse(self.path("a.glb").exists())
        self.assertTrue(self.succeed_json(*command, "-o", "a.glb")["volumes"]["resumed"])
        self.assertFalse(self.succeed_json(*command, "-o", "whole.glb")["volumes"]["resumed"])
        self.assertEqual(self.path("a.glb").read_bytes(), self.path("whole.glb").read_bytes())
        self.assertEqual(list(self.folder.glob("*checkpoint*")), [])

    def test_a_raw_grid_is_a_scene(self):
        with open(self.path("smoke.raw"), "wb") as file:
            file.write(bytes(range(0, 216)))
        name = str(self.path("smoke.raw")) + "?size=6x6x6&density=9"
        estimate = self.succeed_json("bake", name, *QUICK, "--estimate")["volumes"]
        self.assertEqual(estimate["voxels"], 216)
        self.assertGreater(estimate["memory_bytes"], estimate["file_bytes"])
        self.succeed("scene", name, "-o", "smoke.glb")
        self.assertIsNone(self.succeed_json("info", "smoke.glb")["volumes"][0]["transfer"])
        self.refuse("render", self.path("smoke.raw"), "-o", "a.png", says=["smoke.raw", "size=64x64x64"])
        self.refuse("render", str(self.path("smoke.raw")) + "?size=6x6x7", "-o", "a.png", says=["216 bytes", "252"])

    def test_who_does_not_know_volumes_says_so(self):
        said = self.succeed("reference", SCENE, *SMALL, "--spp", "1", "-o", "r.exr").err
        self.assertIn("cloud left out", said)
        self.refuse("compare", SCENE, "-o", "page", says=["holds volumes (cloud)", "path tracer"])
        said = self.succeed("bake", "builtin:furnace?detail=0.25", *QUICK, "--scatterings", "3", "-o", "f.glb").err
        self.assertIn("--scatterings has no effect", said)
        self.refuse("bake", SCENE, "--scatterings", "0", "-o", "a.glb", says="--scatterings")


if __name__ == "__main__":
    unittest.main()
