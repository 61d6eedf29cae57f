# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam compare: what it measures is what its files hold, and bad input is refused before anything is written."""
import csv
import json
import math
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import exr
from harness import BOX, GLOAM, CliTest, glb, moving_triangle, triangle

TECHNIQUES = "irradiance,prt,prt:order=2"
MEASURES = ["rmse", "relative_squared_error", "psnr", "ssim", "flip", "mean_signed_error"]
VIEW = ["--size", "40x32", "--env", "sky:noon"]
QUICK = [*VIEW, "--spp", "4", "--frames", "2"]


def baked_box(folder, environment):
    """A box with one bounce, and its name in the folder."""
    subprocess.run([GLOAM, "bake", BOX, "--order", "3", "--bounces", "1", "--directions", "256", "--bounce-directions", "64",
                    "-o", "box.glb", "--quiet"], cwd=folder, env=environment, check=True, timeout=120)
    return "box.glb"


class Compared(CliTest):
    """One comparison that all tests of a class look at."""

    @classmethod
    def setUpClass(cls):
        cls.shared = pathlib.Path(tempfile.mkdtemp(prefix="gloam-compare-"))
        cls.addClassCleanup(shutil.rmtree, cls.shared, ignore_errors=True)
        cls.env = dict(os.environ, XDG_CACHE_HOME=str(cls.shared / "cache"), GLOAM_VALIDATION="1")
        baked_box(cls.shared, cls.env)
        cls.scene = str(cls.shared / "box.glb")
        cls.arguments = ["compare", cls.scene, "--techniques", TECHNIQUES, *QUICK, "-o", "out"]
        cls.process = subprocess.run([GLOAM, *cls.arguments, "--json"], cwd=cls.shared, env=cls.env, capture_output=True,
                                     text=True, timeout=300, check=False)
        assert cls.process.returncode == 0, cls.process.stderr
        cls.results = json.loads((cls.shared / "out" / "results.json").read_text(encoding="utf-8"))

    def shared_gloam(self, *arguments):
        return subprocess.run([GLOAM, *map(str, arguments)], cwd=self.shared, env=self.env, capture_output=True, text=True,
                              timeout=300, check=False)


class Results(Compared):
    def test_shape_that_programs_read(self):
        self.assertLessEqual({"scene", "environment", "bounces", "size", "device", "techniques"}, set(self.results))
        self.assertEqual((self.results["scene"], self.results["size"], self.results["bounces"]), (self.scene, "40x32", 1))
        self.assertEqual([technique["name"] for technique in self.results["techniques"]], ["irradiance", "prt", "prt"])
        for technique in self.results["techniques"]:
            for layer in technique, technique["direct"], technique["indirect"]:
                self.assertLessEqual(set(MEASURES), set(layer))
            self.assertLessEqual({"settings", "device_ms", "passes", "memory_bytes", "bake_seconds"}, set(technique))
            self.assertGreater(technique["device_ms"], 0)
            self.assertGreater(technique["memory_bytes"], 0)
            for entry in technique["passes"]:
                self.assertEqual(set(entry), {"name", "median_ms", "p95_ms"})
        self.assertEqual(self.results["techniques"][2]["settings"]["order"], 2)
        self.assertEqual(json.loads(self.process.stdout), self.results)

    def test_a_measure_that_does_not_apply_is_null(self):
        irradiance, prt = self.results["techniques"][:2]
        self.assertNotIn("environment_indirect", irradiance["covers"])
        self.assertEqual({irradiance["indirect"][name] for name in MEASURES}, {None})
        self.assertIsNotNone(prt["indirect"]["rmse"])
        self.assertIsNone(prt["bake_seconds"])

    def test_what_is_left_out_is_what_the_scene_has(self):
        irradiance, prt = self.results["techniques"][:2]
        self.assertIn("environment_indirect", irradiance["leaves_out"])
        self.assertNotIn("environment_indirect", prt["leaves_out"])
        for technique in irradiance, prt:
            self.assertFalse(set(technique["covers"]) & set(technique["leaves_out"]))

    def test_the_files(self):
        names = sorted(path.name for path in (self.shared / "out").iterdir())
        self.assertEqual(names, ["index.html", "irradiance.exr", "prt.exr", "prt_order=2.exr", "reference.exr",
                                 "reference_irradiance.exr", "reference_prt.exr", "results.csv", "results.json"])

    def test_measures_follow_from_the_files(self):
        for technique in self.results["techniques"]:
            _, _, ours, _ = exr.read(self.shared / "out" / technique["file"])
            width, height, truth, _ = exr.read(self.shared / "out" / technique["reference_file"])
            self.assertEqual((width, height), (40, 32))
            seen = [i for i, alpha in enumerate(truth["A"]) if alpha > 0]
            self.assertTrue(seen)
            for prefix, layer in ("", technique), ("direct.", technique["direct"]), ("indirect.", technique["indirect"]):
                if layer["rmse"] is None:
                    continue
                pairs = [(ours[prefix + c][i], truth[prefix + c][i]) for c in "RGB" for i in seen]
                square = math.fsum((a - b) ** 2 for a, b in pairs)
                self.assertAlmostEqual(layer["rmse"], math.sqrt(square / len(pairs)), delta=1e-9)
                self.assertAlmostEqual(layer["relative_squared_error"], square / math.fsum(b * b for _, b in pairs), delta=1e-9)
                self.assertAlmostEqual(layer["mean_signed_error"], math.fsum(a - b for a, b in pairs) / len(pairs), delta=1e-9)

    def test_the_reference_of_a_part_is_that_part(self):
        _, _, parts, _ = exr.read(self.shared / "out" / "reference.exr")
        _, _, direct, _ = exr.read(self.shared / "out" / "reference_irradiance.exr")
        covered = [name for name in self.results["techniques"][0]["covers"] if name.endswith("_direct")]
        self.assertTrue(covered)
        for i in range(0, 40 * 32, 37):
            wanted = sum(parts[f"{name}.R"][i] for name in [*covered, "seen"])
            self.assertAlmostEqual(direct["R"][i], wanted, delta=1e-3 * abs(wanted) + 1e-6)
            self.assertEqual(direct["indirect.R"][i], 0)

    def test_every_number_is_what_diff_says(self):
        for technique in self.results["techniques"]:
            command = shlex.split(technique["command"])
            self.assertEqual(command[:2], ["gloam", "diff"])
            for more, layer in ([], technique), (["--layer", "direct"], technique["direct"]), (["--layer", "indirect"], technique["indirect"]):
                if layer["rmse"] is None:
                    continue
                answer = self.shared_gloam(*command[1:], *more, "--json")
                self.assertEqual(answer.returncode, 0, answer.stderr)
                said = json.loads(answer.stdout)
                for name in MEASURES:
                    self.assertEqual(said[name], layer[name], f"{technique['label']} {more} {name}")

    def test_noise_is_that_of_the_light_that_each_is_held_to(self):
        _, _, _, attributes = exr.read(self.shared / "out" / "reference.exr")
        words, parts, covariances = iter(attributes["gloam.part_variance"].split()), [], {}
        for name in words:
            parts.append(name)
            for other in parts:
                covariances[name, other] = covariances[other, name] = float(next(words))
        self.assertIn("environment_direct", parts)
        for technique in self.results["techniques"]:
            held_to = [part for part in parts if part in [*technique["covers"], "seen"]]
            variance = math.fsum(covariances[a, b] for a in held_to for b in held_to)
            width, height, truth, _ = exr.read(self.shared / "out" / technique["reference_file"])
            squares = math.fsum(truth[c][i] ** 2 for c in "RGB" for i in range(width * height) if truth["A"][i] > 0)
            wanted = math.sqrt(variance * 3 * width * height / squares)
            self.assertGreater(wanted, 0)
            self.assertAlmostEqual(technique["reference_noise"], wanted, delta=1e-4 * wanted)

    def test_csv_holds_the_same(self):
        with open(self.shared / "out" / "results.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["layer"] for row in rows], ["sum", "direct", "indirect"] * 3)
        for i, technique in enumerate(self.results["techniques"]):
            for row, layer in zip(rows[3 * i:3 * i + 3], (technique, technique["direct"], technique["indirect"])):
                for name in MEASURES:
                    self.assertEqual(float(row[name]) if row[name] else None, layer[name])
                self.assertEqual(float(row["device_ms"]), technique["device_ms"])

    def test_the_same_command_takes_the_reference_up_again(self):
        reference = self.shared / "out" / "reference.exr"
        before = reference.stat().st_mtime_ns
        again = self.shared_gloam(*self.arguments)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn("taken from", again.stderr)
        self.assertEqual(reference.stat().st_mtime_ns, before)

    def test_a_given_reference(self):
        answer = self.shared_gloam("compare", "box.glb", "--techniques", "prt", "--env", "sky:noon", "--frames", "1", "--reference",
                                   "out/reference.exr", "-o", "given", "--json")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        given = json.loads(answer.stdout)
        self.assertEqual(given["size"], "40x32")
        for name in MEASURES:
            self.assertEqual(given["techniques"][0][name], self.results["techniques"][1][name])
        self.assertFalse((self.shared / "given" / "reference.exr").exists())
        self.assertNotIn("cannot be checked", answer.stderr)

    def test_a_reference_from_a_view_of_ones_own(self):
        view = "builtin:cornell?detail=0.3", "--eye", "0.7,1.3,3.1", "--target", "0.1,0.9,0", "--size", "24x20", "--bounces", "1"
        traced = self.shared_gloam("reference", *view, "--spp", "2", "--parts", "-o", "view.exr")
        self.assertEqual(traced.returncode, 0, traced.stderr)
        answer = self.shared_gloam("compare", *view, "--techniques", "irradiance", "--frames", "1", "--reference", "view.exr", "-o", "viewed")
        self.assertEqual(answer.returncode, 0, answer.stderr)

    def given(self, reference, *more, scene="box.glb", light=("--env", "sky:noon")):
        return self.shared_gloam("compare", scene, "--techniques", "irradiance", *light, "--frames", "1", "--reference", reference, *more,
                                 "-o", "other", "--json")

    def test_a_reference_of_something_else_is_refused(self):
        for says, case in {
                "another scene": {"scene": "builtin:cornell?detail=0.3"},
                "another light": {"light": ("--env", "sky:noon", "--env-rotation", "90")},
                "--env-intensity": {"light": ("--env", "sky:noon", "--env-intensity", "2")},
                "--env": {"light": ("--env", "sky:overcast")}}.items():
            answer = self.given("out/reference.exr", **case)
            self.assertEqual((answer.returncode, answer.stderr.count("\n")), (2, 1), answer.stderr)
            self.assertIn("out/reference.exr", answer.stderr)
            self.assertIn(says, answer.stderr)
        for more, says in (["--eye", "3,1,2"], "another camera"), (["--fov", "20"], "another camera"), (["--sh-order", "3"], "--sh-order: 3"), \
                (["--spp", "9"], "--spp"), (["--noise", "0.1"], "--noise"), (["--seed", "1"], "--seed"):
            answer = self.given("out/reference.exr", *more)
            self.assertEqual((answer.returncode, answer.stderr.count("\n")), (2, 1), answer.stderr)
            self.assertIn(says, answer.stderr)
        self.assertFalse((self.shared / "other").exists())

    def test_a_written_scene_is_the_one_that_it_was_made_from(self):
        self.shared_gloam("scene", BOX.removeprefix("builtin:"), "-o", "written.glb")
        self.shared_gloam("reference", BOX, *VIEW, "--no-background", "--spp", "1", "--parts", "-o", "builtin.exr")
        answer = self.given("builtin.exr", scene="written.glb")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertNotIn("cannot be checked", answer.stderr)
        shutil.rmtree(self.shared / "other")

    def test_a_bake_is_the_scene_that_it_was_made_from(self):
        self.shared_gloam("scene", BOX.removeprefix("builtin:"), "-o", "plain.glb")
        self.shared_gloam("reference", "plain.glb", *VIEW, "--no-background", "--spp", "1", "--sh-order", "3", "--parts", "-o", "plain.exr")
        answer = self.given("plain.exr")  # of one sample: its variance is infinite
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("plain.exr is lit by 3 bands", answer.stderr)
        self.assertEqual(json.loads(answer.stdout)["environment_order"], 3)
        shutil.rmtree(self.shared / "other")


class Lists(CliTest):
    def test_what_deforms_altogether_is_compared_without_a_bake(self):
        document, binary = moving_triangle()
        document["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}]
        document["meshes"][0]["weights"] = [0.5]
        self.path("morph.glb").write_bytes(glb(document, binary))
        small = ["--size", "16x16", "--spp", "2", "--frames", "1", "--env", "sky:mild", "-o", "out"]
        answer = self.succeed("compare", "morph.glb", *small)
        self.assertIn("left out: prt (all meshes are skinned or morphed", answer.err)
        self.assertIn("left out: splatting (covers nothing of environment_direct", answer.err)
        names = [technique["name"] for technique in json.loads(self.path("out/results.json").read_text(encoding="utf-8"))["techniques"]]
        self.assertNotIn("prt", names)
        self.assertIn("proxies", names)
        more = json.loads(self.succeed("compare", "morph.glb", *small, "--techniques", "all,irradiance:order=2", "--json").out)
        self.assertEqual([technique["label"] for technique in more["techniques"]], [*names, "irradiance order=2"])
        shutil.rmtree(self.path("out"))
        self.refuse("compare", "morph.glb", *small, "--techniques", "irradiance,prt", says="skinned or morphed")

    def test_emitters_that_a_technique_cannot_see_are_named(self):
        for still in (True, False):
            document, binary = triangle() if still else moving_triangle()
            document["materials"] = [{"emissiveFactor": [1, 1, 1]}]
            document["meshes"][0]["primitives"][0]["material"] = 0
            document["nodes"][0]["name"] = "pane"
            if not still:
                document["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}]
                document["meshes"][0]["weights"] = [0.5]
            self.path("glow.glb").write_bytes(glb(document, binary))
            answer = self.succeed("compare", "glow.glb", "--env", "none", "--size", "24x16", "--spp", "2", "--frames", "1",
                                  "--techniques", "spherical_lights", "-o", "out")
            said = "spherical_lights: light of 'pane' is missing: it has no spheres, and deforms"
            self.assertEqual(said in answer.err, not still, answer.err)

    def test_each_is_held_to_its_own_bounces(self):
        shadow = "builtin:shadow?detail=0.3"
        small = ["compare", shadow, "--size", "24x16", "--env", "sky:noon", "--frames", "1", "--techniques", "proxies"]
        one = json.loads(self.succeed(*small, "--bounces", "1", "--spp", "8", "--json", "-o", "one").out)
        answer = self.succeed(*small, "--bounces", "2", "--spp", "8", "-o", "two")
        self.assertIn("of 2 bounces traced, each is held to its own: proxies to 1", answer.err)
        two = json.loads(self.path("two/results.json").read_text(encoding="utf-8"))
        self.assertEqual([one["bounces"], two["bounces"], two["techniques"][0]["bounces"]], [1, 2, 1])
        for name in MEASURES:
            self.assertAlmostEqual(one["techniques"][0][name], two["techniques"][0][name], delta=1e-3 * abs(one["techniques"][0][name]))
        self.succeed("reference", shadow, "--size", "24x16", "--env", "sky:noon", "--no-background", "--bounces", "2", "--spp", "2", "-o", "sum.exr")
        given = [part for part in small if part not in ("--size", "24x16")]
        answer = self.succeed(*given, "--reference", "sum.exr", "-o", "given")
        self.assertIn("proxies: its light has 1 bounce, the reference 2 in one sum: what is missing counts as error", answer.err)

    def test_no_bounces_are_no_indirect_light(self):
        view = ["--size", "24x16", "--spp", "2", "--frames", "1", "--env", "sky:mild"]
        self.succeed("bake", BOX, "--kind", "ds", "--directions", "256", "-o", "ds.glb")
        self.succeed("compare", "ds.glb", *view, "--techniques", "prt,proxies,proxies:indirect=off", "-o", "out")
        results = json.loads(self.path("out/results.json").read_text(encoding="utf-8"))
        self.assertEqual([results["bounces"], *(t["bounces"] for t in results["techniques"])], [1, 0, 1, 0])
        for technique in results["techniques"][0], results["techniques"][2]:
            self.assertIn("environment_indirect", technique["leaves_out"])
            self.assertIsNone(technique["indirect"]["rmse"])
        answer = self.succeed("compare", "ds.glb", *view, "--bounces", "0", "--techniques", "proxies", "-o", "none")
        self.assertIn("proxies: the reference has no bounces: direct light alone is measured", answer.err)
        none = json.loads(self.path("none/results.json").read_text(encoding="utf-8"))["techniques"][0]
        self.assertEqual([none["bounces"], none["own_bounces"]], [0, 1])
        self.assertEqual([none[name] for name in MEASURES], [none["direct"][name] for name in MEASURES])
        said = self.succeed_json(*shlex.split(none["command"])[1:])
        self.assertEqual([none[name] for name in MEASURES], [said[name] for name in MEASURES])

    def test_bounces_of_light_that_is_not_there_are_not_traced(self):
        self.succeed("bake", BOX, "--bounces", "2", "--directions", "256", "--bounce-directions", "64", "-o", "two.glb")
        results = json.loads(self.succeed("compare", "two.glb", "--env", "none", "--size", "24x16", "--spp", "1", "--frames", "1", "--json",
                                          "-o", "out").out)
        self.assertNotIn("prt", [technique["name"] for technique in results["techniques"]])
        self.assertEqual(results["bounces"], 1)

    def test_what_shines_itself_is_not_measured(self):
        small = ["compare", "builtin:lanterns?detail=0.3", "--size", "48x32", "--spp", "4", "--frames", "1", "--techniques", "irradiance"]
        results = json.loads(self.succeed(*small, "--json", "-o", "out").out)
        _, _, truth, _ = exr.read(self.path("out/reference_irradiance.exr"))
        seen = [max(truth[f"seen.{c}"][i] for c in "RGB") for i in range(48 * 32)]
        measured = sum(alpha > 0 and shines <= 0 for alpha, shines in zip(truth["A"], seen))
        self.assertGreater(sum(shines > 0 for shines in seen), 0)
        self.assertEqual(self.succeed_json("diff", "out/irradiance.exr", "out/reference_irradiance.exr", "--foreground")["pixels"], measured)
        command = shlex.split(results["techniques"][0]["command"])
        for name in MEASURES:
            self.assertEqual(self.succeed_json(*command[1:])[name], results["techniques"][0][name])

    def test_a_folder_keeps_no_pictures_of_another_comparison(self):
        small = ["compare", BOX, "--size", "16x12", "--env", "sky:noon", "--spp", "2", "--frames", "1", "-o", "out"]
        self.succeed(*small, "--techniques", "irradiance,irradiance:order=2")
        self.path("out/mine.exr").write_text("not gloam's")
        self.succeed(*small, "--techniques", "irradiance")
        self.assertEqual(sorted(path.name for path in self.path("out").iterdir()),
                         ["index.html", "irradiance.exr", "mine.exr", "reference.exr", "reference_irradiance.exr", "results.csv", "results.json"])

    def test_noise_that_is_not_reached_is_exit_code_1(self):
        answer = self.gloam("compare", BOX, "--size", "16x12", "--env", "sky:noon", "--techniques", "irradiance", "--noise", "0.0001", "--spp", "4",
                            "--frames", "1", "-o", "out")
        self.assertEqual(answer.code, 1, str(answer))
        self.assertIn("noise is still", answer.err)
        self.assertTrue(self.path("out/index.html").exists())


class Interrupted(CliTest):
    def test_what_is_finished_stays(self):
        process = subprocess.Popen([GLOAM, "compare", BOX, "--techniques", "irradiance", *VIEW, "--frames", "1", "--spp", "1000000", "-o", "out"],
                                   cwd=self.folder, env=self.environment, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not self.path("out/irradiance.exr").exists():
            self.assertLess(time.monotonic(), deadline)
            self.assertIsNone(process.poll())
            time.sleep(0.02)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        err = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1, err)
        self.assertIn("interrupted", err)
        self.assertIn("reference.checkpoint", err)
        self.assertTrue(self.path("out/reference.checkpoint").exists())
        self.assertFalse(self.path("out/index.html").exists())
        self.succeed("compare", BOX, "--techniques", "irradiance", *VIEW, "--frames", "1", "--spp", "2", "-o", "out")
        self.assertFalse(self.path("out/reference.checkpoint").exists())
        self.assertTrue(self.path("out/index.html").exists())


class Refused(CliTest):
    def refused(self, *arguments, says):
        return self.refuse("compare", BOX, *QUICK, *arguments, "-o", "out", says=says)

    def test_techniques(self):
        self.refused("--techniques", "irradiance,radiosity", says=["--techniques", "radiosity", "irradiance"])
        self.refused("--techniques", "", says=["--techniques", "empty"])
        self.refused("--techniques", "prt,", says=["--techniques", "expected", "prt"])
        self.refused("--techniques", "prt:order", says=["--techniques", "order", "OPTION=VALUE"])
        self.refused("--techniques", "prt:orde=3", says=["prt:orde=3", "orde"])
        self.refused("--techniques", "prt:order=30", says=["prt:order=30", "30"])
        self.refused("--techniques", "prt,irradiance,prt:order=0", says=["prt order=0", "same"])
        self.refused("--techniques", "prt,irradiance,prt", says="'prt' stands twice")

    def test_a_technique_that_cannot_light_this_scene(self):
        self.refuse("compare", "builtin:furnace?detail=0.25", "--env", "none", "--techniques", "irradiance", "-o", "out",
                    says=["irradiance", "cannot light", "no light"])

    def test_numbers(self):
        self.refused("--spp", "0", says=["--spp", "0"])
        self.refused("--bounces", "-1", says="--bounces")
        self.refused("--sh-order", "7", says="--sh-order")
        for noise in "nan", "0", "-1":
            self.refused("--noise", noise, says=["--noise", noise, "expected a number above 0"])
        self.refused("--frames", "0", says="--frames")
        self.refused("--exposure", "foo", says=["--exposure", "foo", "auto"])

    def test_where_to(self):
        self.path("out").write_text("a file")
        self.refused("--techniques", "irradiance", says=["out", "file"])
        self.refuse("compare", BOX, *QUICK, "--techniques", "irradiance", "-o", "no/such/folder", says="no/such/folder")


class References(CliTest):
    LIGHT = {"gloam.kind": "reference", "gloam.light": "environment_direct environment_indirect", "gloam.bounces": "1"}

    def reference(self, attributes=None, **changed):
        channels = {f"{prefix}{c}": value for prefix, value in (("", 0.5), ("direct.", 0.25), ("indirect.", 0.25)) for c in "RGB"} | {"A": 1.0}
        for name in changed.pop("without", []):
            del channels[name]
        exr.write(self.path("truth.exr"), 8, 6, channels | {name.replace("_", "."): value for name, value in changed.items()},
                  self.LIGHT if attributes is None else attributes)

    def refused(self, *more, says):
        self.refuse("compare", BOX, "--env", "sky:noon", "--techniques", "irradiance", "--frames", "1", "--reference", "truth.exr", *more,
                    "-o", "out", says=says)

    def test_not_there_or_no_picture(self):
        self.refused(says="truth.exr")
        self.path("truth.exr").write_text("no picture")
        self.refused(says="truth.exr")

    def test_that_does_not_say_what_it_holds(self):
        self.reference(attributes={})
        self.refused(says=["truth.exr", "gloam reference"])

    def test_that_does_not_say_what_it_shows(self):
        self.reference(attributes=self.LIGHT | {"gloam.light": "environment_direct local_direct"})
        answer = self.succeed("compare", BOX, "--env", "sky:noon", "--techniques", "irradiance", "--frames", "1", "--reference", "truth.exr",
                              "-o", "out")
        self.assertIn("truth.exr", answer.err)
        self.assertIn("cannot be checked", answer.err)
        self.assertIn("truth.exr has no channel object.id", answer.err)
        self.assertIn("truth.exr does not say how noisy it is", answer.err)

    def test_of_another_size(self):
        self.reference()
        self.refused("--size", "9x6", says=["--size", "9x6", "8x6", "truth.exr"])
        self.refused("--bounces", "3", says=["--bounces", "truth.exr"])

    def test_with_values_that_are_no_numbers(self):
        values = [0.5] * 48
        values[8 * 2 + 3] = math.nan
        self.reference(direct_G=values)
        self.refused(says=["truth.exr", "direct.G", "not a number", "3, 2"])
        values[8 * 2 + 3] = math.inf
        self.reference(R=values)
        self.refused(says=["truth.exr", "channel R", "infinite"])

    def test_whose_layers_contradict_one_another(self):
        self.reference(direct_R=1.0)
        self.refused(says=["truth.exr", "R, G, B is not the sum of layers direct and indirect"])
        parts = {f"environment_direct.{c}": 0.25 for c in "RGB"} | {f"environment_indirect.{c}": 0.5 for c in "RGB"}
        channels = {f"{prefix}{c}": value for prefix, value in (("", 1.0), ("direct.", 0.5), ("indirect.", 0.5)) for c in "RGB"}
        exr.write(self.path("truth.exr"), 8, 6, channels | {"A": 1.0} | {f"seen.{c}": 0.0 for c in "RGB"} | parts, self.LIGHT)
        self.refused(says="object.id is missing")

    def test_with_variances_that_cannot_be(self):
        for value, says in (math.nan, "not a number"), (-1.0, "below 0"):
            self.reference(variance_R=value, variance_G=0.1, variance_B=0.1)
            self.refused(says=["truth.exr", "variance.R", says])
        for name, value in ("gloam.part_variance", "junk"), ("gloam.part_variance", "seen -1"), ("gloam.variance", "nan"):
            self.reference(attributes=self.LIGHT | {"gloam.light": "environment_direct local_direct", name: value})
            self.refused(says=["truth.exr", f"attribute {name}", *value.split()])

    def test_without_numbers_of_objects(self):
        self.reference(object_id=1.0)
        self.refused(says=["truth.exr", "object.id holds no whole numbers"])
        self.reference(seen_R=0.0, seen_G=0.0, seen_B=0.0)
        self.refused(says=["truth.exr", "object.id is missing"])

    def test_without_a_layer(self):
        self.reference(without=["direct.R", "direct.G", "direct.B"])
        self.refused(says=["truth.exr", "direct"])

    def test_with_parts_but_not_their_sums(self):
        parts = {f"{name}_{way}.{c}": 0.5 for name in ("environment", "local") for way in ("direct", "indirect") for c in "RGB"}
        channels = {f"{prefix}{c}": 0.5 for prefix in ("", "direct.") for c in "RGB"} | {f"seen.{c}": 0.0 for c in "RGB"} | {"A": 1.0} | parts
        exr.write(self.path("truth.exr"), 8, 6, channels, self.LIGHT | {"gloam.light": "environment_direct environment_indirect local_direct local_indirect"})
        self.refused(says=["truth.exr", "indirect"])

    def test_with_attributes_that_cannot_be(self):
        for name, value in ("gloam.bounces", "many"), ("gloam.bounces", "-1"), ("gloam.environment_order", "7"), ("gloam.supersample", "0"), \
                ("gloam.background", "yes"), ("gloam.noise", "-1"), ("gloam.samples", "1e3"), ("gloam.size", "16x6"):
            self.reference(attributes=self.LIGHT | {name: value})
            self.refused(says=["truth.exr", f"attribute {name}", value])

    def test_by_another_tracer_is_taken_with_a_line(self):
        self.reference(attributes=self.LIGHT | {"gloam.light": "environment_direct local_direct", "gloam.version": "0.0.1"})
        answer = self.succeed("compare", BOX, "--env", "sky:noon", "--techniques", "irradiance", "--frames", "1", "--reference", "truth.exr",
                              "-o", "out")
        self.assertIn("truth.exr was traced by gloam 0.0.1", answer.err)

    def test_without_the_light_that_is_covered(self):
        self.reference(attributes=self.LIGHT | {"gloam.light": "local_direct"})
        self.refused(says=["truth.exr", "environment_direct"])


if __name__ == "__main__":
    unittest.main()
