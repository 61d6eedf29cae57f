# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam bake --neighbourhood: grids round objects, and what they do to others."""
import signal
import subprocess
import time
import unittest

from harness import GLOAM, SMALL, CliTest

QUICK = ["--directions", "256", "--bounce-directions", "64", "--order", "3", "--bounces", "1", "--grid", "6"]
SCENE = "builtin:passing?detail=0.25"


class Neighbourhood(CliTest):
    def test_what_moves_throws_shadow_on_others(self):
        result = self.succeed_json("bake", SCENE, *QUICK, "--neighbourhood", "auto", "-o", "a.glb")
        self.assertTrue(result["apart"])
        self.assertEqual([grid["object"] for grid in result["neighbourhoods"]], ["vane", "ball", "ground"])
        for grid in result["neighbourhoods"]:
            self.assertEqual(grid["grid"], [6, 6, 6])
            self.assertTrue(0 < grid["near_error"] < grid["worst_error"] < 1 and 0 < grid["error"] < 0.5, grid)
            self.assertFalse(grid["resumed"])
        light = []
        for switch in "false", "true":
            self.succeed("render", "a.glb", *SMALL, "--time", "2", "--prt.neighbourhood", switch, "-o", "a.exr")
            light.append(self.means("a.exr", "direct")["G"])
        self.assertLess(light[1], 0.99 * light[0])

    def test_a_name_a_size_and_halves(self):
        command = ["bake", SCENE, *QUICK, "--neighbourhood", "vane", "--neighbourhood-reach", "0.5"]
        result = self.succeed_json(*command, "--grid", "4x3x5", "-o", "a.glb")
        self.assertEqual(result["neighbourhoods"][0]["grid"], [4, 3, 5])
        half = self.succeed_json(*command, "--grid", "4x3x5", "--half", "-o", "b.glb")
        self.assertLess(half["file_bytes"], 0.8 * result["file_bytes"])
        self.assertIn("effect", self.succeed("bake", SCENE, "--kind", "du", "--order", "3", "--grid", "5", "-o", "c.glb").err)

    def test_the_estimate_writes_nothing(self):
        estimate = self.succeed_json("bake", SCENE, *QUICK, "--neighbourhood", "vane,ball", "--estimate")
        self.assertEqual(len(estimate["neighbourhoods"]), 2)
        self.assertTrue(all(grid["memory_bytes"] > grid["file_bytes"] > 0 for grid in estimate["neighbourhoods"]))
        for choice, objects in ("auto", ["vane", "ball", "ground"]), ("all", ["ground", "vane", "ball"]):
            estimate = self.succeed_json("bake", SCENE, *QUICK, "--neighbourhood", choice, "--estimate")
            self.assertEqual([grid["object"] for grid in estimate["neighbourhoods"]], objects)
        said = self.succeed("bake", SCENE, *QUICK, "--neighbourhood", "vane", "--grid", "40", "--memory", "140M", "--estimate").err
        self.assertIn("grids of fewer points (--grid)", said)
        self.assertIn("neighbourhood of vane: 6 x", self.succeed("bake", SCENE, *QUICK, "--neighbourhood", "vane", "--estimate").out)
        self.assertEqual(list(self.folder.glob("*.glb")), [])

    def stopped(self, command, how):
        """Stops the command once transfer is finished and grids are under way; its last line."""
        process = subprocess.Popen([GLOAM, *map(str, command)], cwd=self.folder, env=self.environment, stderr=subprocess.PIPE, text=True)
        last = self.path("a.glb.checkpoint.2")  # of the third object
        end = time.monotonic() + 60
        while not last.exists() and process.poll() is None and time.monotonic() < end:
            time.sleep(0.005)
        time.sleep(0.05)
        process.send_signal(how)
        said = process.communicate(timeout=60)[1]
        self.assertTrue(self.path("a.glb.checkpoint").exists(), said)
        self.assertFalse(self.path("a.glb").exists(), said)
        return said.splitlines()[-1]

    def test_finished_work_is_kept_whatever_happens(self):
        command = ["bake", SCENE, *QUICK, "--directions", "8192", "--grid", "16", "--neighbourhood", "vane,ball"]
        whole = self.succeed_json(*command, "-o", "whole.glb")
        self.assertFalse(whole["resumed"])
        for how in signal.SIGKILL, signal.SIGINT:  # seconds after the beginning: nothing is due to be kept by the clock
            said = self.stopped([*command, "-o", "a.glb"], how)
            if how == signal.SIGINT:
                self.assertIn("the same command goes on from a.glb.checkpoint", said)
            self.refuse(*command, "--order", "4", "-o", "a.glb", says=["a.glb.checkpoint", "--no-resume"])
            result = self.succeed_json(*command, "-o", "a.glb")
            self.assertTrue(result["resumed"])
            self.assertEqual(result["rays"] + result["bounce_rays"], 0, "transfer was finished")
            self.assertEqual(self.path("a.glb").read_bytes(), self.path("whole.glb").read_bytes())
            self.assertEqual(sorted(p.name for p in self.folder.glob("*checkpoint*")), [])
            self.path("a.glb").unlink()
        self.stopped([*command, "-o", "a.glb"], signal.SIGKILL)
        self.assertFalse(self.succeed_json(*command, "--no-resume", "-o", "a.glb")["resumed"])
        self.assertEqual(sorted(p.name for p in self.folder.glob("*checkpoint*")), [])

    def test_bad_input(self):
        bake = ["bake", SCENE, *QUICK, "-o", "a.glb", "--neighbourhood"]
        self.refuse(*bake, "vnae", says=["--neighbourhood", "'vnae'", "vane", "ground"])
        self.refuse("bake", "builtin:cornell?detail=0.25", "--neighbourhood", "auto", "-o", "a.glb", says=["auto", "take all, or name an object"])
        self.refuse(*bake, "", says=["--neighbourhood", "empty"])
        self.refuse(*bake, "vane,,ball", says=["--neighbourhood", "empty name between commas"])
        self.refuse(*bake, "vane", "--grid", "", says="--grid")
        self.refuse(*bake, "vane", "--grid", "3", says="--grid")
        self.refuse(*bake, "vane", "--grid", "8x8", says="--grid")
        self.refuse(*bake, "vane", "--grid", "8x8x1", says="--grid")
        self.refuse(*bake, "vane", "--neighbourhood-reach", "-1", says="--neighbourhood-reach")
        self.refuse(*bake, "vane", "--order", "6", "--grid", "128x128x128", says=["128 x 128 x 128", "memory"])
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
