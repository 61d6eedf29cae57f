# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam reference: pictures by paths; what is asked for is what comes out, interruptions leave no trace."""
import signal
import subprocess
import time
import unittest

from harness import BOX, GLOAM, SMALL, CliTest, hdr, spinning_triangle

LAYERS = {"", "direct", "indirect", "normal", "depth", "albedo", "object", "variance", "seen"}
QUICK = ["--spp", "8"]
SKY = ["--env", "sky:uniform"]


class Pictures(CliTest):
    def attributes(self, name):
        return self.picture(name)["attributes"]

    def test_parts_need_a_file_that_holds_layers(self):
        for output in "a.png", "a.hdr", "frames", "a_####.png", "a.mp4":
            self.refuse("reference", BOX, *SMALL, "--parts", "-o", output, says=["--parts", output, "x.exr"])

    def test_exr_holds_all_layers_and_says_what_is_in_it(self):
        result = self.succeed_json("reference", BOX, *SMALL, *QUICK, "--bounces", "3", "--seed", "5", "-o", "a.exr")
        self.assertEqual((result["size"], result["samples"], result["bounces"], result["outputs"]), ("48x32", 8, 3, ["a.exr"]))
        self.assertGreater(result["rays"], 48 * 32 * 8)
        self.assertGreater(result["rays_per_s"], 0)
        self.assertFalse(result["resumed"])
        layers = {layer["name"]: layer["type"] for layer in self.picture("a.exr")["layers"]}
        self.assertEqual(set(layers), LAYERS)
        self.assertEqual((layers[""], layers["direct"], layers["variance"]), ("float", "float", "float"))
        attributes = self.attributes("a.exr")
        for name, value in ("kind", "reference"), ("bounces", "3"), ("samples", "8"), ("seed", "5"), ("environment_order", "0"):
            self.assertEqual(attributes[f"gloam.{name}"], value)
        self.assertEqual(attributes["gloam.light"], result["light"])
        self.assertAlmostEqual(float(attributes["gloam.noise"]), result["noise"], delta=1e-3 * result["noise"])
        self.assertIn("gloam.samples: 8", self.succeed("info", "a.exr").out)
        self.assertFalse(self.path("a.exr.checkpoint").exists())

    def test_says_what_it_is_a_picture_of(self):
        def prints(*arguments):
            self.succeed("reference", BOX, "--size", "8", "--spp", "1", *arguments, "-o", "a.exr")
            attributes = self.attributes("a.exr")
            return [attributes[f"gloam.{name}"] for name in ("scene", "environment_light", "camera")]

        plain = prints(*SKY)
        self.assertEqual(plain, prints(*SKY, "--seed", "4", "--bounces", "0", "--sh-order", "2"))
        for place, other in enumerate((prints(*SKY, "--ground", "--eye", "2,3,4", "--target", "0,0,0"), prints(*SKY, "--env-intensity", "2"),
                                       prints(*SKY, "--fov", "20"))):
            self.assertNotEqual(plain[place], other[place])
            if place > 0:
                self.assertEqual(plain[0], other[0])

    def test_much_noise_is_remarked(self):
        few = self.succeed("reference", "builtin:lamp", "--size", "24", "--spp", "2", "-o", "a.exr")
        self.assertIn("four times the samples", few.err)
        calm = self.succeed("reference", "builtin:furnace?detail=0.25", "--size", "24", *SKY, "--spp", "16", "-o", "a.exr")
        self.assertNotIn("four times the samples", calm.err)

    def test_geometry_is_that_of_a_render(self):
        for verb in "render", "reference":
            options = QUICK if verb == "reference" else []
            self.succeed(verb, BOX, *SMALL, "--supersample", "2", *options, "-o", f"{verb}.exr")
        for layer in "normal", "depth", "albedo", "object":
            ours, theirs = self.means("reference.exr", layer), self.means("render.exr", layer)
            for channel, mean in theirs.items():
                self.assertAlmostEqual(ours[channel], mean, delta=0.01 * abs(mean) + 2e-3, msg=f"{layer}.{channel}")

    def test_the_furnace_is_white(self):
        self.succeed("reference", "builtin:furnace?detail=0.25", *SMALL, *SKY, "--bounces", "2", "--spp", "64", "-o", "a.exr")
        means = self.means("a.exr")
        for channel in "RGB":
            self.assertAlmostEqual(means[channel], 1.0, delta=0.02)

    def test_same_command_same_bytes_whatever_the_threads(self):
        for name, threads in ("a.exr", 1), ("b.exr", 3):
            self.succeed("reference", BOX, *SMALL, *QUICK, "--threads", threads, "-o", name)
        self.assertEqual(self.path("a.exr").read_bytes(), self.path("b.exr").read_bytes())
        self.succeed("reference", BOX, *SMALL, *QUICK, "--seed", "1", "-o", "c.exr")
        self.assertNotEqual(self.path("a.exr").read_bytes(), self.path("c.exr").read_bytes())

    def test_png_and_hdr_and_default_name(self):
        for name in "a.png", "a.hdr":
            self.succeed("reference", BOX, *SMALL, *QUICK, "--exposure", "auto", "-o", name)
            self.assertEqual(self.picture(name)["size"], "48x32")
        self.succeed("reference", BOX, *SMALL, *QUICK)
        self.assertEqual(self.picture("cornell_reference.exr")["size"], "48x32")

    def test_remarks(self):
        self.path("bare.glb").write_bytes(spinning_triangle())
        err = self.succeed("reference", "bare.glb", *SMALL, *QUICK, "-o", "a.png").err
        self.assertIn("sky:mild", err)
        self.assertIn("wrote a.png (8 samples", err)
        self.assertEqual(self.succeed("reference", "bare.glb", *SMALL, *QUICK, "-o", "a.png", "--quiet").err, "")

    def test_samples_are_even_among_positions(self):
        result = self.succeed("reference", BOX, *SMALL, *QUICK, "--supersample", "3", "-o", "a.exr")
        self.assertIn("9 samples instead of 8", result.err)
        self.assertEqual(self.attributes("a.exr")["gloam.samples"], "9")

    def test_without_background_alpha_is_coverage(self):
        self.succeed("reference", "builtin:furnace?detail=0.25", *SMALL, *SKY, *QUICK, "--no-background", "-o", "a.exr")
        means = self.means("a.exr")
        self.assertTrue(0.01 < means["A"] < 0.99)
        self.assertAlmostEqual(means["R"], means["A"], delta=0.03)

    def test_settings_from_a_file(self):
        self.path("s.json").write_text('{"size": "20x10", "spp": 4, "only": "environment,lamps", "bounces": 0}')
        result = self.succeed_json("reference", BOX, "--settings", "s.json", "-o", "a.exr")
        self.assertEqual((result["size"], result["samples"], result["bounces"]), ("20x10", 4, 0))
        self.assertIn("local_direct", result["light"])
        self.assertNotIn("emitter", result["light"])


class Light(CliTest):
    def sum_of(self, *options):
        self.succeed("reference", BOX, *SMALL, "--env", "sky:mild", "--spp", "64", "--bounces", "2", *options, "-o", "a.exr")
        return self.means("a.exr")["G"]

    def test_parts_add_up(self):
        result = self.succeed_json("reference", BOX, *SMALL, *QUICK, "--env", "sky:mild", "--parts", "-o", "a.exr")
        names = {layer["name"] for layer in self.picture("a.exr")["layers"]}
        self.assertEqual(names, LAYERS | set(result["sources"].split()))
        parts = sum(self.means("a.exr", name)["G"] for name in names - LAYERS | {"seen"})
        self.assertAlmostEqual(parts, self.means("a.exr")["G"], delta=1e-4)

    def test_only_limits_the_light(self):
        whole = self.sum_of("--parts")
        seen = self.means("a.exr", "seen")["G"]
        environment, local = self.sum_of("--only", "environment"), self.sum_of("--only", "local")
        self.assertGreater(environment, 1.05 * seen)
        self.assertGreater(local, 1.05 * seen)
        self.assertAlmostEqual(environment + local - seen, whole, delta=0.05 * whole)
        self.assertAlmostEqual(self.sum_of("--only", "environment,local"), whole, delta=0.05 * whole)
        self.assertAlmostEqual(self.sum_of("--only", "lamps", "--only", "emitters"), local, delta=0.05 * local)

    def test_direct_and_indirect(self):
        self.sum_of("--direct")
        self.assertEqual(self.means("a.exr", "indirect")["G"], 0)
        direct = self.means("a.exr", "direct")["G"]
        self.sum_of("--indirect")
        self.assertGreater(self.means("a.exr", "indirect")["G"], 0)
        self.assertLess(self.means("a.exr", "direct")["G"], direct)
        self.sum_of("--direct", "--indirect")
        self.assertGreater(self.means("a.exr", "indirect")["G"], 0)

    def test_nothing_that_sends_such_light_is_said(self):
        furnace = "reference", "builtin:furnace?detail=0.25", *SMALL, *SKY, *QUICK
        self.refuse(*furnace, "--only", "lamps", "-o", "a.png", says=["--only", "no light of lamps", "environment_direct"])
        self.refuse(*furnace, "--indirect", "--bounces", "0", "-o", "a.png", says=["--indirect", "--bounces 1"])
        dark = self.succeed(*furnace, "--env", "none", "-o", "a.png").err
        self.assertIn("nothing in the scene sends", dark)

    def test_projection_of_the_sky(self):
        light = []
        for order in 0, 1, 3:
            self.succeed("reference", "builtin:furnace?detail=0.25", *SMALL, *QUICK, "--env", "sky:sunset", "--sh-order", order,
                         "--no-background", "-o", "a.exr")
            self.assertEqual(self.picture("a.exr")["attributes"]["gloam.environment_order"], str(order))
            light.append(self.means("a.exr")["B"])
        self.assertEqual(len(set(light)), 3)

    def test_bounces_brighten(self):
        dark, bright = (self.sum_of("--bounces", n) for n in (0, 4))
        self.assertGreater(bright, 1.02 * dark)


class Goals(CliTest):
    def test_stops_by_noise(self):
        result = self.succeed_json("reference", BOX, "--size", "16x12", "--noise", "0.2", "-o", "a.exr")
        self.assertLessEqual(result["noise"], 0.2)
        self.assertLess(result["samples"], 65536)

    def test_noise_that_is_not_reached_is_exit_code_1(self):
        result = self.gloam("reference", BOX, *SMALL, "--noise", "0.0001", "--spp", "20", "-o", "a.exr")
        self.assertEqual(result.code, 1, str(result))
        self.assertIn("noise is still", result.err)
        self.assertEqual(self.picture("a.exr")["attributes"]["gloam.samples"], "20")


class Motion(CliTest):
    def test_time_and_frames(self):
        self.path("a.glb").write_bytes(spinning_triangle())
        common = ["reference", "a.glb", *SMALL, *SKY, *QUICK, "--no-background"]
        alphas = []
        for seconds in 0, 1:
            self.succeed(*common, "--time", seconds, "-o", "a.exr")
            alphas.append(self.means("a.exr")["A"])
        self.assertGreater(alphas[0], 0.01)
        self.assertEqual(alphas[1], 0)
        self.succeed(*common, "--animate", "0:1", "--fps", "3", "-o", "f_##.exr")
        self.assertEqual(sorted(p.name for p in self.folder.glob("f_*")), ["f_00.exr", "f_01.exr", "f_02.exr"])
        self.assertEqual(self.path("f_00.exr").stat().st_size > 0, True)
        self.succeed(*common, "--orbit", "2", "-o", "turn")
        self.assertEqual(len(list(self.path("turn").iterdir())), 2)

    def test_skinned_meshes_are_traced_where_they_stand(self):
        depths = []
        for seconds in "0", "0.5":
            self.succeed("reference", "builtin:walker?detail=0.25", *SMALL, *SKY, "--spp", "1", "--time", seconds, "-o", "a.exr")
            depths.append(self.means("a.exr", "depth")["Z"])
        self.assertNotEqual(depths[0], depths[1])


class Interruptions(CliTest):
    LONG = ["reference", BOX, "--size", "64x48", "--spp", "600", "--bounces", "2"]

    def test_goes_on_and_gives_the_same_bytes(self):
        err = self.interrupt(*self.LONG, "-o", "a.exr", output="a.exr")
        self.assertIn("goes on", err.splitlines()[-1])
        self.refuse(*self.LONG, "--bounces", "1", "-o", "a.exr", says=["a.exr.checkpoint", "--no-resume"])
        resumed = self.succeed_json(*self.LONG, "-o", "a.exr")
        self.assertTrue(resumed["resumed"])
        self.assertFalse(self.path("a.exr.checkpoint").exists())
        self.succeed(*self.LONG, "-o", "b.exr")
        self.assertEqual(self.path("a.exr").read_bytes(), self.path("b.exr").read_bytes())

    def test_foreign_and_damaged_checkpoints(self):
        quick = ["reference", BOX, *SMALL, *QUICK, "-o", "a.exr"]
        self.path("a.exr.checkpoint").write_bytes(b"of something else")
        self.refuse(*quick, says=["a.exr.checkpoint", "--no-resume"])
        self.interrupt(*self.LONG, "--no-resume", "-o", "a.exr", output="a.exr")
        whole = self.path("a.exr.checkpoint").read_bytes()
        for damaged in whole[:len(whole) // 2], whole[:-1000] + bytes([whole[-1000] ^ 1]) + whole[-999:]:
            self.path("a.exr.checkpoint").write_bytes(damaged)
            self.refuse(*self.LONG, "-o", "a.exr", says=["a.exr.checkpoint", "damaged", "--no-resume"])
        self.assertFalse(self.succeed_json(*quick, "--no-resume")["resumed"])

    def test_a_sequence_keeps_its_finished_frames(self):
        self.path("a.glb").write_bytes(spinning_triangle())
        process = subprocess.Popen([GLOAM, "reference", "a.glb", *SMALL, *SKY, "--spp", "16", "--orbit", "50000", "-o", "frames"],
                                   cwd=self.folder, env=self.environment, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while not self.path("frames/frame_0001.png").exists():
            self.assertLess(time.monotonic(), deadline, "no second frame")
            self.assertIsNone(process.poll())
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        err = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, 1, err)
        self.assertIn("frames are written", err)
        self.assertEqual([p.suffix for p in self.path("frames").iterdir()][:1], [".png"])


class BadInput(CliTest):
    def test_options(self):
        for value in "0", "-1":
            self.refuse("reference", BOX, "--noise", value, "-o", "a.exr", says=[value, "expected a number above 0"])
        for option, value in ("--spp", 0), ("--spp", -4), ("--spp", "x"), ("--spp", 16777217), ("--noise", 0), ("--noise", -0.1), \
                ("--noise", "nan"), ("--bounces", -1), ("--bounces", 1.5), ("--sh-order", 7), ("--threads", -1), ("--seed", -1), \
                ("--only", "moon"), ("--only", "environment,lampz"), ("--size", "0x4"), ("--supersample", 5), ("--time", "inf"):
            self.refuse("reference", BOX, option, value, "-o", "a.exr", says=[option, str(value).split(",")[-1]])
        self.refuse("reference", BOX, "--only", "emiters", "-o", "a.exr", says="did you mean emitters")
        self.refuse("reference", says="missing")

    def test_outputs_that_cannot_be_written_are_found_before_any_work(self):
        for name, says in ("no/a.exr", "no/a.exr"), ("a.xyz", ".xyz"), ("a.jpg", ".jpg"):
            self.refuse("reference", "none.glb", "-o", name, says=says)
        self.refuse("reference", BOX, "--orbit", "3", "-o", "a.exr", says=["a.exr", "folder"])
        self.path("probe.hdr").write_bytes(hdr())
        self.refuse("reference", BOX, "--env", "probe.hdr", "-o", "probe.hdr", says="probe.hdr")

    def test_inputs(self):
        self.refuse("reference", "none.glb", "-o", "a.exr", says="none.glb")
        self.refuse("reference", BOX, "--env", "none.hdr", "-o", "a.exr", says="none.hdr")
        self.refuse("reference", BOX, "--camera", "7", "-o", "a.exr", says="7")


if __name__ == "__main__":
    unittest.main()
