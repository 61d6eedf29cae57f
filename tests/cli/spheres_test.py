# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam bake spheres, and render --show spheres."""
import json
import re
import shutil
import signal
import subprocess
import time
import unittest

from harness import BOX, GLOAM, SMALL, SOURCE, CliTest, glb, triangle

QUICK = ["--effort", "0.02", "--samples", "500"]


class Spheres(CliTest):
    def bake(self, *arguments):
        return self.succeed_json("bake", "spheres", *arguments, *QUICK)

    def test_says_what_it_reached_and_writes_it(self):
        result = self.bake(BOX, "-k", "10", "-o", "a.spheres.json")
        objects = {entry["name"]: entry for entry in result["objects"]}
        self.assertIn("flat", objects["floor"]["receive_only"])
        self.assertGreater(objects["tall box"]["coverage"], 0.999)
        self.assertLessEqual(objects["tall box"]["outside_union"], objects["tall box"]["outside_sum"])
        self.assertLessEqual(result["spheres"], 10)
        written = json.loads(self.path("a.spheres.json").read_text(encoding="utf-8"))
        self.assertEqual(written["format"], "gloam spheres")
        self.assertEqual(sum(len(entry["spheres"]) for entry in written["sets"]), result["spheres"])
        text = self.succeed("bake", "spheres", BOX, "-k", "4", *QUICK, "-o", "a.spheres.json").out
        self.assertRegex(text, r"tall box: \d+ spheres?; outside [\d.]+ % of its volume")

    def test_same_bits_for_any_number_of_threads(self):
        for threads in 1, 3:
            self.bake(BOX, "-k", "6", "--threads", threads, "-o", f"{threads}.json")
        self.assertEqual(self.path("1.json").read_bytes(), self.path("3.json").read_bytes())

    def test_bad_input_is_an_answer_each(self):
        for count in "0", "-3", "5000", "many":
            self.refuse("bake", "spheres", BOX, "-k", count, says="count")
        self.refuse("bake", "spheres", "missing.glb", says="missing.glb")
        self.refuse("bake", "spheres", BOX, "-o", "a.png", says=[".json", "a.png"])
        self.refuse("bake", "spheres", says=["gloam bake spheres", "missing"])
        self.refuse("bake", "spheres", BOX, "--bounces", "2", says="--bounces")

    def test_baked_sets_are_drawn_and_those_of_another_model_refused(self):
        self.bake(BOX, "-k", "6", "-o", "box.json")
        draw = ["--technique", "proxies", *SMALL, "--no-cache"]
        self.succeed("render", BOX, *draw, "--spheres", "box.json", "-o", "a.png")
        sets = json.loads(self.path("box.json").read_text(encoding="utf-8"))
        for entry in sets["sets"]:
            for sphere in entry["spheres"]:
                sphere[3] *= 0.5
        self.path("less.json").write_text(json.dumps(sets), encoding="utf-8")
        self.succeed("render", BOX, *draw, "--spheres", "less.json", "-o", "b.png")
        self.assertNotEqual(self.path("a.png").read_bytes(), self.path("b.png").read_bytes())
        self.refuse("render", "builtin:shadow", *draw, "--spheres", "box.json", "-o", "c.png",
                    says=["box.json", "another model"])
        bench = ["bench", "proxies", *SMALL, "--frames", "1"]
        self.succeed(*bench, BOX, "--spheres", "less.json")
        self.refuse(*bench, "builtin:shadow", "--spheres", "box.json", says="box.json")
        self.refuse(*bench, "--scaling", "--spheres", "box.json", says="--spheres")
        self.refuse("render", BOX, *draw, "--spheres", "missing.json", "-o", "c.png", says="missing.json")
        text = self.succeed("render", BOX, "--technique", "irradiance", *SMALL, "--spheres", "box.json", "-o", "d.png").err
        self.assertIn("takes none", text)

    def test_a_triangle_only_receives(self):
        self.path("a.glb").write_bytes(glb(*triangle()))
        result = self.bake("a.glb", "-o", "a.json")
        self.assertIn("flat", result["objects"][0]["receive_only"])
        self.assertEqual(result["spheres"], 0)

    def test_a_file_called_spheres_is_still_a_file(self):
        self.path("a.glb").write_bytes(glb(*triangle([(0, 0, 0), (1, 0, 0), (0, 1, 0)])))
        shutil.copy(self.path("a.glb"), self.path("spheres"))
        self.succeed("bake", "./spheres", "--directions", "256", "--bounces", "1", "-o", "b.glb")
        self.refuse("bake", "--estimate", "nowhere", says="nowhere")

    def test_interruption_leaves_nothing(self):
        process = subprocess.Popen([GLOAM, "bake", "spheres", "builtin:walker?detail=0.3", "--effort", "50", "-o", "a.json"],
                                   cwd=self.folder, env=self.environment, stderr=subprocess.PIPE, text=True)
        time.sleep(2.0)
        process.send_signal(signal.SIGINT)
        err = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1, err)
        self.assertIn("interrupted", err.splitlines()[-1])
        self.assertEqual(self.listing(), [])

    def test_every_option_is_in_the_docs(self):
        text = (SOURCE / "docs" / "cli.md").read_text(encoding="utf-8")
        self.assertTrue("## gloam bake spheres" in text)
        section = text[text.index("## gloam bake spheres"):].split("\n## ")[0]
        for option in re.findall(r"(?m)^  (?:-\w, )?(--[a-z-]+)", self.succeed("bake", "spheres", "--help").out):
            if option not in ("--help", "--quiet", "--json"):
                self.assertTrue(option in section, option)


class ShowSpheres(CliTest):
    def test_spheres_are_drawn_over_the_model_and_kept(self):
        said = []
        for _ in range(2):
            said.append(self.succeed("render", BOX, *SMALL, "--show", "spheres", "-o", "a.png").err)
        self.assertIn("fitting", said[0])
        self.assertIn("taken from", said[1])
        self.succeed("render", BOX, *SMALL, "-o", "plain.png")
        self.assertNotEqual(self.path("a.png").read_bytes(), self.path("plain.png").read_bytes())

    def test_spheres_as_they_cast_are_smaller(self):
        for layer in ("spheres", "shadow_spheres"):
            self.succeed("render", BOX, *SMALL, "--show", layer, "-o", f"{layer}.png")
        self.assertNotEqual(self.path("spheres.png").read_bytes(), self.path("shadow_spheres.png").read_bytes())

    def test_a_damaged_file_in_the_cache_is_made_anew(self):
        self.path("a.glb").write_bytes(glb(*triangle()))
        show = ["render", "a.glb", *SMALL, "--show", "spheres", "-o", "a.png"]
        self.succeed(*show)
        kept = list(self.path("cache").rglob("*.spheres.json"))
        self.assertEqual(len(kept), 1)
        kept[0].write_text('{"format": "gloam spheres", "version": 1, "sets": [{}]}', encoding="utf-8")
        self.assertIn("fitting", self.succeed(*show).err)
        self.assertIn("taken from", self.succeed(*show).err)


if __name__ == "__main__":
    unittest.main()
