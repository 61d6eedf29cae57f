# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam render and bench: pictures, frames, videos; what is asked for is what comes out."""
import json
import signal
import subprocess
import time
import unittest

from harness import BOX, GLOAM, SMALL, CliTest, hdr, spinning_triangle

LAYERS = {"", "direct", "indirect", "normal", "depth", "albedo", "object"}
LIGHT = ["--env", "sky:uniform"]


class Pictures(CliTest):
    def test_what_is_baked_for_local_light_is_baked_apart(self):
        small = "render", "builtin:lanterns?detail=0.25", "--technique", "prt", "--size", "16x12", "-o", "a.png"
        self.assertIn("their transfer holds for the instant", self.succeed(*small).err)
        answer = self.succeed(*small, "--prt.local_light", "all")
        self.assertIn("baking it first", answer.err)
        self.assertNotIn("baked as one object", answer.err)

    def test_a_picture_without_light_is_said(self):
        dark = self.succeed("render", "builtin:furnace?detail=0.25", "--env", "none", "--size", "8x8", "-o", "a.png").err
        self.assertIn("nothing in the scene sends light", dark)
        glow = self.succeed("render", "builtin:bumps?detail=0.25", "--env", "none", "--size", "8x8", "--technique", "irradiance", "-o", "a.png").err
        self.assertIn("irradiance has no light here: it covers environment_direct, local_direct, the scene has emitter_direct", glow)
        self.assertNotIn("light here", self.succeed("render", "builtin:cornell?detail=0.25", "--env", "none", "--size", "8x8", "-o", "a.png").err)

    def test_png_of_the_right_size_that_is_not_black(self):
        result = self.succeed_json("render", BOX, *SMALL, "-o", "a.png")
        self.assertEqual((result["size"], result["outputs"]), ("48x32", ["a.png"]))
        self.assertEqual(result["technique"], "irradiance")
        declared = {option["name"]: option["default"] for technique in self.succeed_json("list", "--techniques")["techniques"]
                    for option in technique["options"] if technique["name"] == "irradiance"}
        self.assertEqual(result["settings"], declared)
        self.assertTrue(result["passes"])
        picture = self.picture("a.png")
        self.assertEqual(picture["size"], "48x32")
        for channel in picture["layers"][0]["channels"][:3]:
            self.assertTrue(0.01 < channel["mean"] < 0.99, channel)

    def test_exr_holds_all_layers_and_their_sum(self):
        self.succeed("render", BOX, *SMALL, "-o", "a.exr")
        layers = {layer["name"] for layer in self.picture("a.exr")["layers"]}
        self.assertEqual(layers, LAYERS)
        sums, direct, indirect = self.means("a.exr"), self.means("a.exr", "direct"), self.means("a.exr", "indirect")
        for channel in "RGB":
            self.assertGreaterEqual(sums[channel] * 1.01 + 1e-3, direct[channel] + indirect[channel])

    def test_default_name(self):
        self.succeed("render", BOX, *SMALL)
        self.assertEqual(self.picture("cornell.png")["size"], "48x32")

    def test_same_command_same_bytes(self):
        for name in "a.exr", "b.exr":
            self.succeed("render", BOX, *SMALL, "-o", name)
        self.assertEqual(self.path("a.exr").read_bytes(), self.path("b.exr").read_bytes())

    def test_intensity_scales_light(self):
        for name, factor in ("a.exr", 1), ("b.exr", 2):
            self.succeed("render", "builtin:furnace?detail=0.25", *SMALL, *LIGHT, "--env-intensity", factor, "-o", name)
        self.assertAlmostEqual(self.means("b.exr")["R"], 2 * self.means("a.exr")["R"], delta=0.01)

    def test_rotation_by_a_full_turn_changes_nothing_and_half_a_turn_does(self):
        for name, turn in ("a.exr", 0), ("b.exr", 360), ("c.exr", 180):
            self.succeed("render", "builtin:spheres?detail=0.25", *SMALL, "--env", "sky:sunset", "--env-rotation", turn, "-o", name)
        a, b, c = (self.means(name)["R"] for name in ("a.exr", "b.exr", "c.exr"))
        self.assertAlmostEqual(a, b, delta=1e-3 * a)
        self.assertGreater(abs(a - c), 1e-3 * a)

    def test_probe_from_a_file(self):
        self.path("probe.hdr").write_bytes(hdr(8, 4, (128, 0, 0, 130)))
        self.succeed("render", "builtin:furnace?detail=0.25", *SMALL, "--env", "probe.hdr", "-o", "a.exr")
        means = self.means("a.exr")
        self.assertGreater(means["R"], 1.5)
        self.assertLess(means["G"], 0.01)

    def test_without_background_alpha_is_coverage(self):
        self.succeed("render", "builtin:furnace?detail=0.25", *SMALL, *LIGHT, "--no-background", "-o", "a.exr")
        self.assertTrue(0.01 < self.means("a.exr")["A"] < 0.99)
        self.succeed("render", "builtin:furnace?detail=0.25", *SMALL, *LIGHT, "-o", "b.exr")
        self.assertAlmostEqual(self.means("b.exr")["A"], 1.0, places=3)

    def test_exposure_and_tone_map(self):
        means = []
        for options in ["--exposure", "0"], ["--exposure", "-1"], ["--exposure", "auto"], ["--tone-map", "none"]:
            self.succeed("render", BOX, *SMALL, *options, "-o", "a.png")
            means.append(self.means("a.png")["G"])
        self.assertGreater(means[0], means[1])
        self.assertEqual(len(set(means)), 4)

    def test_layers_can_be_shown(self):
        for layer in LAYERS - {""}:
            self.succeed("render", BOX, *SMALL, "--show", layer, "-o", "a.png")

    def test_images_of_a_technique_can_be_shown(self):
        line = self.refuse("render", BOX, *SMALL, "--show", "nrmal", says="nrmal")
        names = [word.strip(",") for word in line.split() if "." in word]
        self.assertTrue(names, line)
        self.succeed("render", BOX, *SMALL, "--show", names[0], "-o", "a.png")

    def test_remarks_and_quiet(self):
        self.path("bare.glb").write_bytes(spinning_triangle())
        err = self.succeed("render", "bare.glb", *SMALL, "-o", "a.png").err
        self.assertIn("sky:mild", err)
        self.assertIn("wrote a.png", err)
        self.assertEqual(self.succeed("render", "bare.glb", *SMALL, "-o", "a.png", "--quiet").err, "")

    def test_a_picture_is_replaced_whole(self):
        self.path("a.png").write_bytes(b"old")
        self.succeed("render", BOX, *SMALL, "-o", "a.png")
        self.assertEqual(self.picture("a.png")["size"], "48x32")


class Cameras(CliTest):
    def means_of(self, *options):
        self.path("a.glb").write_bytes(spinning_triangle())
        self.succeed("render", "a.glb", *SMALL, *LIGHT, "--no-background", *options, "-o", "a.exr")
        return self.means("a.exr")["A"]

    def test_named_numbered_placed(self):
        first = self.means_of()
        self.assertGreater(first, 0.01)
        self.assertEqual(first, self.means_of("--camera", "front"))
        self.assertEqual(first, self.means_of("--camera", "0"))
        self.assertAlmostEqual(first, self.means_of("--eye", "0,0,4", "--target", "0,0,0", "--fov", "45.8366"), places=2)
        self.assertGreater(self.means_of("--eye", "0,0,3", "--target", "0,0,0"), first)
        self.assertEqual(self.means_of("--eye", "0,0,4", "--target", "0,0,9"), 0)
        self.assertLess(self.means_of("--fov", "90"), first)

    def test_wrong_ones(self):
        self.path("a.glb").write_bytes(spinning_triangle())
        self.refuse("render", "a.glb", "--camera", "back", says=["back", "front"])
        self.refuse("render", "a.glb", "--camera", "7", says="7")
        self.refuse("render", "a.glb", "--camera", "0", "--eye", "1,1,1", says="--eye")
        self.refuse("render", "a.glb", "--target", "1,1,1", says="--eye")
        self.refuse("render", "a.glb", "--eye", "1,1,1", "--target", "1,1,1", says="--target")


class Motion(CliTest):
    def setUp(self):
        super().setUp()
        self.path("a.glb").write_bytes(spinning_triangle())

    def test_time_moves_the_triangle(self):
        alphas = []
        for seconds in 0, 0.5, 1:
            self.succeed("render", "a.glb", *SMALL, *LIGHT, "--no-background", "--time", seconds, "-o", "a.exr")
            alphas.append(self.means("a.exr")["A"])
        self.assertGreater(alphas[0], 0.01)
        self.assertEqual(alphas[2], 0, "after 1 s the triangle is out of the picture")

    def test_animation_to_a_folder(self):
        result = self.succeed_json("render", "a.glb", *SMALL, "--animate", "0:1", "--fps", "4", "-o", "frames")
        names = [f"frames/frame_{i:04}.png" for i in range(4)]
        self.assertEqual(result["outputs"], names)
        self.assertEqual(sorted(f"frames/{p.name}" for p in self.path("frames").iterdir()), names)
        self.assertNotEqual(self.path(names[0]).read_bytes(), self.path(names[3]).read_bytes())

    def test_numbered_names(self):
        self.succeed("render", "a.glb", *SMALL, *LIGHT, "--orbit", "2", "-o", "turn_##.exr")
        self.assertEqual(sorted(p.name for p in self.folder.glob("turn*")), ["turn_00.exr", "turn_01.exr"])

    def test_turntable_and_animation_to_video(self):
        for name, options in ("turn.mp4", ["--orbit", "5"]), ("walk.mp4", ["--animate", "0:0.5", "--fps", "10"]):
            self.succeed("render", "a.glb", "--size", "33x17", *LIGHT, *options, "-o", name)
            probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                    "stream=width,height,nb_read_frames", "-of", "json", self.path(name)],
                                   capture_output=True, text=True, check=True)
            stream = json.loads(probe.stdout)["streams"][0]
            self.assertEqual((stream["width"], stream["height"], stream["nb_read_frames"]), (34, 18, "5"))

    def test_one_picture_cannot_hold_many_frames(self):
        self.refuse("render", "a.glb", "--orbit", "3", "-o", "a.png", says=["a.png", "folder"])

    def test_video_without_ffmpeg(self):
        empty = dict(self.environment, PATH=str(self.folder))
        self.refuse("render", "a.glb", *SMALL, "--orbit", "2", "-o", "a.mp4", environment=empty, says="ffmpeg")

    def test_interrupt_keeps_finished_frames(self):
        process = subprocess.Popen([GLOAM, "render", "a.glb", "--size", "64x64", *LIGHT, "--orbit", "50000", "-o", "frames"],
                                   cwd=self.folder, env=self.environment, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not self.path("frames/frame_0001.png").exists():
            self.assertLess(time.monotonic(), deadline, "no second frame")
            self.assertIsNone(process.poll())
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        err = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1, err)
        self.assertIn("interrupted", err)
        frames = sorted(self.path("frames").iterdir())
        self.assertEqual([p.name for p in frames], [f"frame_{i:04}.png" for i in range(len(frames))])
        self.assertEqual(self.picture(frames[-1].relative_to(self.folder))["size"], "64x64")


class Settings(CliTest):
    def test_file_sets_what_the_command_line_does_not(self):
        self.path("s.json").write_text(json.dumps({"size": "20x10", "env": "sky:uniform", "env_rotation": 90, "quiet": True}))
        result = self.succeed_json("render", BOX, "--settings", "s.json", "-o", "a.png")
        self.assertEqual(result["size"], "20x10")
        result = self.succeed_json("render", BOX, "--size", "8x8", "--settings", "s.json", "-o", "a.png")
        self.assertEqual(result["size"], "8x8")

    def test_bad_files(self):
        for text, says in (("{", "s.json"), ("[1]", "object"), ('{"siez": 1}', "siez"), ('{"size": "0x0"}', "--size"),
                           ('{"size": [1]}', "size"), ('{"prt": {"no_such": 1}}', "prt.no_such"), ("[" * 100000, "s.json"),
                           ('{"technique": "no"}', "no")):
            self.path("s.json").write_text(text)
            self.refuse("render", BOX, "--settings", "s.json", says=says)
        self.refuse("render", BOX, "--settings", "none.json", says="none.json")


class Bench(CliTest):
    def test_json_and_table(self):
        result = self.succeed_json("bench", "irradiance", BOX, *SMALL, "--frames", "3")
        self.assertEqual((result["scene"], result["size"], result["frames"]), (BOX, "48x32", 3))
        self.assertTrue(result["device"])
        self.assertGreater(result["frame_ms"], 0)
        self.assertGreater(result["memory_bytes"], 0)
        for entry in result["passes"]:
            self.assertLessEqual(entry["median_ms"], entry["p95_ms"] + 1e-9, entry)
        out = self.succeed("bench", "irradiance", BOX, *SMALL, "--frames", "2").out
        for entry in result["passes"]:
            self.assertIn(entry["name"], out)

    def test_reference_is_measured_as_it_is_asked_for(self):
        def measured(*arguments):
            return self.succeed_json("bench", "reference", BOX, *arguments)

        plain = measured("--size", "24", "--env", "sky:uniform")
        self.assertEqual((plain["scene"], plain["size"], plain["environment"]), (BOX, "24x24", "sky:uniform"))
        self.assertLessEqual(plain["points"], 24 * 24)
        self.assertEqual(measured(*SMALL, "--env", "none", "--light", "constant?radiance=1")["size"], "48x32")
        self.assertGreater(measured("--size", "24", "--ground")["triangles"], plain["triangles"])
        self.assertGreater(measured("--size", "24", "--supersample", "2")["points"], 2 * plain["points"])
        # A camera far away sees fewer places of the box.
        self.assertLess(measured("--size", "24", "--eye", "9,9,30", "--target", "0,0,0")["points"], plain["points"] / 2)
        self.refuse("bench", "reference", BOX, "--env", "no.exr", says="no.exr")
        self.refuse("bench", "reference", BOX, "--camera", "nobody", says="nobody")

    def test_gloss_is_told_like_for_like(self):
        result = self.succeed_json("bench", "gloss", BOX, "--env", "sky:mild")
        self.assertEqual((result["scene"], result["environment"], result["order"]), (BOX, "sky:mild", 5))
        self.assertEqual([row["exponent"] for row in result["rows"]], [3, 10, 30, 100])
        for row in result["rows"]:
            self.assertLess(row["matrix_error"], 0.03, row)
            self.assertLess(row["shown_exponent"], 10.5, row)
        self.assertLess(result["rows"][0]["truncation"], result["rows"][3]["truncation"])
        self.refuse("bench", "gloss", BOX, "--env", "none", says="bench gloss")

    def test_rays_to_virtual_lights_are_counted_alike(self):
        result = self.succeed_json("bench", "visibility", BOX, "--size", "24", "--supersample", "2")
        self.assertEqual((result["scene"], result["points"], result["sets"]), (BOX, 48 * 48, 64))
        self.assertGreater(result["rays"], 1000)
        self.assertTrue(0.0 < result["open"] < 1.0, result)
        self.assertLess(result["differing"], 1e-3)
        for key in ("bare_mrays_s", "host_mrays_s", "device_mrays_s", "ratio", "walks_ms"):
            self.assertGreater(result[key], 0.0, key)
        self.refuse("bench", "visibility", BOX, "--light", "constant?radiance=0", "--eye", "9,9,30", "--target", "9,9,60",
                    says="bench visibility")

    def test_what_means_nothing_is_refused(self):
        for subject, option, value in (("reference", "--frames", "3"), ("reference", "--device", "0"), ("bake", "--size", "16"),
                                       ("bake", "--env", "none"), ("relight", "--fov", "30"), ("sh", "--size", "16")):
            self.refuse("bench", subject, option, value, says=[option, subject])
        self.refuse("bench", "reference", "--prt.window", "none", says=["--prt.window", "reference"])
        self.refuse("bench", "gloss", BOX, "--size", "64", says=["--size", "gloss"])
        self.refuse("bench", "sh", BOX, says=["SCENE", "sh"])

    def test_unknown_subject(self):
        self.refuse("bench", "no-such", says=["no-such", "irradiance"])

    def check_rows(self, result):
        self.assertEqual(set(result), {"device", "rows"})
        self.assertTrue(result["device"])
        self.assertTrue(result["rows"])
        names = [row["name"] for row in result["rows"]]
        self.assertEqual(len(names), len(set(names)))
        for row in result["rows"]:
            self.assertEqual(set(row), {"name", "ours", "paper", "unit", "better", "command"})
            self.assertIn(row["better"], ["higher", "lower", "none"])
            self.assertIsInstance(row["ours"], float)
            self.assertTrue(row["unit"], row)
            self.assertRegex(row["command"], r"^gloam bench \w+ .*--paper")

    def test_figures_of_a_paper(self):
        ball = self.path("ball.obj")
        ball.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        small = ["ball.obj", "--ground", "--env", "sky:noon", "--proxies.spheres", "1", *SMALL, "--frames", "1"]
        result = self.succeed_json("bench", "proxies", "--paper", *small, "-o", "plot.csv")
        self.check_rows(result)
        rows = {row["name"]: row for row in result["rows"]}
        fit = rows["quadratic fit of D1: relative squared error"]
        self.assertEqual((fit["paper"], fit["unit"]), (0.00016, "%"))
        self.assertLess(fit["ours"], 2 * fit["paper"])
        lines = self.path("plot.csv").read_text().splitlines()
        self.assertEqual(len(lines), 101)
        self.assertTrue(all(float(number) >= 0 for number in lines[-1].split(",")))
        out = self.succeed("bench", "proxies", "--paper", *small, "-o", "plot.svg").out
        for name in rows:
            self.assertIn(name, out)
        self.assertTrue(self.path("plot.svg").read_text().startswith("<svg"))

    def test_time_over_the_number_of_spheres(self):
        result = self.succeed_json("bench", "proxies", "--scaling", *SMALL, "--frames", "1")
        self.assertEqual([point["proxies"] for point in result["points"]], [10, 50, 200, 500, 1000, 2000])
        for point in result["points"]:
            self.assertGreaterEqual(point["frame_ms"], point["light_ms"])

    def test_figures_that_nobody_keeps(self):
        self.refuse("bench", "irradiance", "--paper", says=["--paper", "irradiance", "proxies"])
        self.refuse("bench", "irradiance", "--scaling", says=["--scaling", "spheres"])
        self.refuse("bench", "sh", "--paper", says=["--paper", "sh"])
        self.refuse("bench", "proxies", "--paper", "--scaling", says="--scaling")
        self.refuse("bench", "proxies", BOX, "--scaling", says=["--scaling", BOX])
        self.refuse("bench", "proxies", "-o", "x.svg", says=["--output", "--paper"])
        self.refuse("bench", "proxies", "--scaling", "-o", "x.png", says=["x.png", ".svg"])


if __name__ == "__main__":
    unittest.main()
