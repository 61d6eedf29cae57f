# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam list, info, scene: what there is, what a file holds."""
import os
import pathlib
import re
import subprocess
import unittest

from harness import GLOAM, SMALL, VERBS, CliTest, glb, hdr, spinning_triangle, triangle


class List(CliTest):
    def test_all_sections_for_people(self):
        out = self.succeed("list").out
        for word in "Techniques", "irradiance", "prt", "builtin:cornell", "sky:mild", "Devices":
            self.assertIn(word, out)

    def test_json_has_what_programs_read(self):
        listing = self.succeed_json("list")
        self.assertLessEqual({"techniques", "scenes", "devices", "rows"}, set(listing))
        names = [technique["name"] for technique in listing["techniques"]]
        self.assertEqual(len(names), len(set(names)))
        for technique in listing["techniques"]:
            self.assertLessEqual({"name", "summary", "coverage", "options"}, set(technique))
            self.assertTrue(any(technique["coverage"].values()), technique)
            for option in technique["options"]:
                self.assertLessEqual({"name", "type", "range", "default", "help"}, set(option))
                self.assertIn(option["type"], ["bool", "integer", "number", "choice"])
                if option["type"] == "choice":
                    self.assertIn(option["default"], option["range"])
                elif option["type"] != "bool":
                    low, high = option["range"]
                    self.assertTrue(low <= option["default"] <= high, option)
        self.assertTrue(listing["devices"])
        for row in listing["rows"]:
            self.assertIn(row["works"], ["yes", "partly"])
            self.assertTrue(row["command"].startswith("gloam "), row)
            self.assertTrue(row["test"], row)
            self.assertEqual(bool(row["missing"]), row["works"] == "partly", row)

    def test_sections_can_be_asked_for(self):
        self.assertEqual(list(self.succeed_json("list", "--skies")), ["skies"])
        self.assertEqual(set(self.succeed_json("list", "--rows", "--scenes")), {"rows", "scenes"})
        self.refuse("list", "--markdown", says="--rows")

    def test_commands_of_rows_exist(self):
        for row in self.succeed_json("list", "--rows")["rows"]:
            words = row["command"].split()
            self.assertIn(words[1], VERBS, row)
            help_text = self.succeed(words[1], "--help").out
            for word in words:
                if word.startswith("--"):
                    self.assertIn(word, help_text, row)

    def test_tests_that_rows_name_are_registered(self):
        build = pathlib.Path(GLOAM).resolve().parents[1]
        if not (build / "CMakeCache.txt").exists():
            self.skipTest("gloam is not in its build folder")
        registered = set()
        for file in build.rglob("CTestTestfile.cmake"):
            registered.update(re.findall(r'add_test\(\[=*\[?"?(\w+)', file.read_text(encoding="utf-8")))
        for row in self.succeed_json("list", "--rows")["rows"]:
            for part in row["test"].split("; "):
                self.assertIn(part.split(":")[0], registered, row)

    def test_without_a_driver_it_says_what_to_install(self):
        blind = dict(self.environment, VK_ICD_FILENAMES="/nowhere.json", VK_DRIVER_FILES="/nowhere.json")
        self.refuse("list", "--devices", environment=blind, says="mesa-vulkan-drivers")
        self.refuse("render", "builtin:cornell", *SMALL, environment=blind, says="mesa-vulkan-drivers")
        self.assertEqual(self.succeed_json("list", environment=blind)["devices"], [])

    def test_output_that_does_not_arrive_is_no_success(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full here")
        with open("/dev/full", "w", encoding="ascii") as full:
            process = subprocess.run([GLOAM, "list", "--rows"], stdout=full, stderr=subprocess.PIPE, check=False)
        self.assertEqual(process.returncode, 2)


class Info(CliTest):
    def test_scene(self):
        self.path("a.glb").write_bytes(spinning_triangle())
        info = self.succeed_json("info", "a.glb")
        self.assertEqual((info["kind"], info["triangles"], info["vertices"]), ("scene", 1, 3))
        self.assertEqual(info["duration_s"], 1)
        self.assertEqual([camera["name"] for camera in info["cameras"]], ["front"])
        self.assertIsNone(info["transfer"])
        self.assertIn("triangles: 1", self.succeed("info", "a.glb").out)

    def test_extensions(self):
        document, binary = triangle()
        document["extensionsUsed"] = ["KHR_materials_specular"]
        self.path("a.glb").write_bytes(glb(document, binary))
        self.assertEqual(self.succeed_json("info", "a.glb")["extensions"], ["KHR_materials_specular"])

    def test_probe(self):
        self.path("probe.hdr").write_bytes(hdr(8, 4))
        info = self.succeed_json("info", "probe.hdr")
        self.assertEqual(info["size"], "8x4")
        for value in info["as_environment"]["mean_radiance"]:
            self.assertAlmostEqual(value, 1.0, places=2)

    def test_sky_of_one_radiance(self):
        info = self.succeed_json("info", "sky:uniform")
        means = info["as_environment"]["mean_radiance"]
        self.assertAlmostEqual(info["as_environment"]["brightest_luminance"], means[0], places=4)

    def test_every_builtin_scene(self):
        for scene in self.succeed_json("list", "--scenes")["scenes"]:
            self.assertGreater(self.succeed_json("info", scene["name"])["triangles"], 0)


class SceneVerb(CliTest):
    def test_round_trip_keeps_triangles(self):
        self.succeed("scene", "cornell", "-o", "x.glb")
        made, written = self.succeed_json("info", "builtin:cornell"), self.succeed_json("info", "x.glb")
        for key in "triangles", "triangles_drawn", "meshes":
            self.assertEqual(made[key], written[key], key)

    def test_default_name_and_values(self):
        self.succeed("scene", "builtin:spheres?detail=0.5")
        self.assertTrue(self.path("spheres.glb").exists())

    def test_ground_adds_triangles(self):
        self.path("a.glb").write_bytes(spinning_triangle())
        self.assertGreater(self.succeed_json("scene", "a.glb", "--ground", "-o", "b.glb")["triangles"], 100)

    def test_bad_names(self):
        self.refuse("scene", "no-such", "-o", "x.glb", says="no-such")
        self.refuse("scene", "builtin:no-such", "-o", "x.glb", says=["no-such", "cornell"])
        self.refuse("scene", "cornell", "-o", "x.obj", says=".glb")
        self.refuse("scene", "cornell", "-o", "no/folder/x.glb", says="no/folder")


if __name__ == "__main__":
    unittest.main()
