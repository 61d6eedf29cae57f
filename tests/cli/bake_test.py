# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""gloam bake, and what render does with a bake or without one."""
import os
import pty
import signal
import subprocess
import time
import unittest

from harness import GLOAM, SMALL, CliTest, glb, moving_triangle, spinning_triangle, triangle

QUICK = ["--directions", "256", "--bounce-directions", "256", "--order", "3"]
LONG = ["--directions", "8192", "--bounces", "1", "--bounce-directions", "256"]
SCENE = "builtin:cornell?detail=0.25"


class Bake(CliTest):
    def test_baked_file_says_what_it_holds_and_renders_by_prt(self):
        result = self.succeed_json("bake", SCENE, *QUICK, "--bounces", "2", "-o", "a.glb")
        self.assertEqual((result["order"], result["bounces"], result["directions"]), (3, 2, 256))
        transfer = self.succeed_json("info", "a.glb")["transfer"]
        self.assertEqual((transfer["order"], transfer["bounces"], transfer["directions"]), (3, 2, 256))
        self.assertGreaterEqual(transfer["vertices"], result["points"])
        rendered = self.succeed_json("render", "a.glb", *SMALL, "-o", "a.exr")
        self.assertEqual(rendered["technique"], "prt")
        self.assertGreater(self.means("a.exr", "indirect")["R"], 0)
        self.assertFalse(self.path("a.glb.checkpoint").exists())

    def test_kinds(self):
        light = []
        for kind in "du", "ds", "di":
            self.succeed("bake", SCENE, *QUICK, "--kind", kind, "-o", "a.glb")
            self.assertEqual(self.succeed_json("info", "a.glb")["transfer"]["kind"],
                             {"du": "unshadowed", "ds": "shadowed", "di": "interreflected"}[kind])
            self.succeed("render", "a.glb", *SMALL, "--env", "sky:uniform", "-o", "a.exr")
            light.append(self.means("a.exr"))
        self.assertLess(light[1]["G"], light[0]["G"], "shadows darken")
        self.assertGreater(light[2]["G"], light[1]["G"], "bounces brighten")

    def test_options_without_effect_are_told(self):
        line = "gloam: --{} has no effect on --kind {}".format
        du = self.succeed("bake", SCENE, *QUICK, "--kind", "du", "--bounces", "5", "-o", "a.glb").err
        for option in "bounces", "bounce-directions", "directions":
            self.assertIn(line(option, "du"), du)
        ds = self.succeed("bake", SCENE, *QUICK, "--kind", "ds", "-o", "a.glb").err
        self.assertIn(line("bounce-directions", "ds"), ds)
        self.assertNotIn("--directions has", ds)
        self.assertNotIn("--bounces has", ds)
        self.assertNotIn("no effect", self.succeed("bake", SCENE, *QUICK, "-o", "b.glb").err)
        self.assertIn("baked with 3 bands", self.succeed("render", "b.glb", *SMALL, "--prt.order", "6", "-o", "a.png").err)
        self.assertNotIn("bands", self.succeed("render", "b.glb", *SMALL, "--prt.order", "3", "-o", "a.png").err)

    def test_a_floor_that_is_there_and_one_that_is_not(self):
        document, binary = triangle()
        self.path("a.glb").write_bytes(glb(document, binary))
        self.succeed("bake", "a.glb", *QUICK, "--kind", "du", "-o", "bare.glb")
        self.succeed("bake", "a.glb", *QUICK, "--kind", "du", "--ground", "-o", "floor.glb")
        self.refuse("render", "bare.glb", *SMALL, "--ground", "-o", "a.png", says=["--ground", "bare.glb", "without a floor"])
        again = self.succeed("render", "floor.glb", *SMALL, "--ground", "-o", "a.exr")
        self.assertIn("holds its floor already", again.err)
        self.succeed("render", "floor.glb", *SMALL, "-o", "b.exr")
        self.assertEqual(self.path("a.exr").read_bytes(), self.path("b.exr").read_bytes())

    def test_motion_of_baked_meshes_is_told(self):
        document, binary = moving_triangle()
        words = "holds for the instant of the bake"
        self.path("one.glb").write_bytes(glb(document, binary))
        self.assertNotIn(words, self.succeed("bake", "one.glb", *QUICK, "-o", "a.glb").err)
        document["nodes"].append({"mesh": 0, "translation": [0, 5, 0]})
        document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)
        self.path("two.glb").write_bytes(glb(document, binary))
        self.assertIn(words, self.succeed("bake", "two.glb", *QUICK, "-o", "a.glb").err)

    def test_gloss_is_baked_where_something_mirrors(self):
        scene = "builtin:bronze?detail=0.25"
        result = self.succeed_json("bake", scene, *QUICK, "--bounces", "1", "-o", "a.glb")
        self.assertGreater(result["points"], result["glossy_points"], "red and blue clay mirror nothing")
        self.assertTrue(0.02 < result["cheap_error"] < 0.3, result["cheap_error"])
        glossy = self.succeed_json("info", "a.glb")["transfer"]["glossy"]
        self.assertEqual((glossy["light_order"], glossy["radiance_order"], glossy["exponent"]), (3, 3, None))
        self.assertTrue(glossy["interreflected"])
        light = {}
        for choice in "matrix", "cheap", "unshadowed":
            self.succeed("render", "a.glb", *SMALL, "--env", "sky:uniform", "--no-background", "--prt.glossy", choice, "-o", "a.exr")
            light[choice] = self.means("a.exr", "direct")["G"], self.means("a.exr", "indirect")["G"]
        self.assertLess(light["matrix"][0], 0.95 * light["unshadowed"][0], "gloss is shadowed")
        self.assertGreater(light["matrix"][1], 1.2 * light["unshadowed"][1], "gloss reflects")
        self.assertLess(abs(light["cheap"][0] / light["matrix"][0] - 1), 0.1)

        self.assertEqual(self.succeed_json("bake", scene, *QUICK, "--glossy", "off", "-o", "b.glb")["glossy_points"], 0)
        self.assertIsNone(self.succeed_json("info", "b.glb")["transfer"]["glossy"])
        self.succeed("bake", scene, "--directions", "256", "--order", "4", "--kind", "ds", "--glossy", "on", "--glossy-order", "5",
                     "--glossy-light-order", "3", "--bake-gloss", "6", "--half", "-o", "c.glb")
        glossy = self.succeed_json("info", "c.glb")["transfer"]["glossy"]
        self.assertEqual((glossy["light_order"], glossy["radiance_order"], glossy["exponent"]), (3, 5, 6))
        self.assertFalse(glossy["interreflected"])

    def test_light_that_does_not_go_into_the_file_is_told(self):
        document, binary = triangle()
        document["extensionsUsed"] = ["EXT_lights_image_based"]
        coefficients = [[1, 1, 1]] + [[0, 0, 0]] * 8
        document["extensions"] = {"EXT_lights_image_based": {"lights": [
            {"irradianceCoefficients": coefficients, "specularImages": [], "specularImageSize": 1}]}}
        document["scenes"][0]["extensions"] = {"EXT_lights_image_based": {"light": 0}}
        self.path("lit.glb").write_bytes(glb(document, binary))
        words = "does not go into a .glb: give it by --env"
        self.assertIn(words, self.succeed("bake", "lit.glb", *QUICK, "--kind", "du", "-o", "a.glb").err)
        self.assertIn(words, self.succeed("scene", "lit.glb", "-o", "b.glb").err)
        self.assertNotIn(words, self.succeed("bake", SCENE, *QUICK, "--kind", "du", "-o", "a.glb").err)  # a sky by name

    def test_components_take_less_room_and_say_what_they_cost(self):
        whole = self.succeed_json("bake", SCENE, *QUICK, "-o", "whole.glb")
        self.assertIsNone(whole["pca"])
        small = self.succeed_json("bake", SCENE, *QUICK, "--pca", "16x9", "--half", "-o", "small.glb")["pca"]
        self.assertLess(small["bytes"], small["bytes_before"] / 1.4)
        self.assertTrue(0 < small["transfer_error"] < 0.05, small)
        self.assertGreaterEqual(small["worst_light_error"], small["light_error"])
        self.assertIn("errs by", self.succeed("bake", SCENE, *QUICK, "--pca", "4x4", "-o", "a.glb").err)
        light = []
        for name in "whole", "small":
            self.succeed("render", f"{name}.glb", *SMALL, "-o", "a.exr")
            light.append(self.means("a.exr")["G"])
        self.assertLess(abs(light[1] / light[0] - 1), 0.01)
        for value in "16", "0x4", "4x0", "4x", "x4", "4x4x4", "5000x4", "4x145", "axb":
            self.refuse("bake", SCENE, *QUICK, "--pca", value, "-o", "b.glb", says=["--pca", value, "64x20"])

    def test_half_floats_halve_the_transfer(self):
        sizes = []
        for options in [], ["--half"]:
            self.succeed("bake", SCENE, *QUICK, *options, "-o", "a.glb")
            sizes.append(self.path("a.glb").stat().st_size)
        self.assertLess(sizes[1], 0.75 * sizes[0])

    def test_estimate_alone_writes_nothing(self):
        estimate = self.succeed_json("bake", SCENE, *QUICK, "--estimate")
        self.assertTrue(0 < estimate["rays"] <= estimate["vertices"] * 256, estimate)
        self.assertGreater(estimate["memory_bytes"], 0)
        self.assertEqual(self.listing(), [])
        self.assertIn("vertices", self.succeed("bake", SCENE, "--estimate").out)

    def test_the_estimate_is_near_the_file(self):
        for scene, options in (SCENE, []), (SCENE, ["--half"]), (SCENE, ["--pca", "4x6"]), (SCENE, ["--pca", "8x9", "--half"]), \
                ("builtin:bronze?detail=0.25", ["--half"]), ("builtin:gallery?detail=0.25", ["--texels", "16"]), \
                ("builtin:passing?detail=0.25", ["--neighbourhood", "auto", "--grid", "5", "--half"]):
            expected = self.succeed_json("bake", scene, *QUICK, *options, "--estimate")["file_bytes"]
            size = self.succeed_json("bake", scene, *QUICK, *options, "-o", "a.glb")["file_bytes"]
            self.assertTrue(0.8 < size / expected <= 1.0, (scene, options, size, expected))

    def test_the_estimate_does_not_do_the_work(self):
        said = self.succeed("bake", "builtin:gallery?detail=0.25", "--tessellate", "0.05", "--tessellate-max", "9000", "--estimate")
        self.assertIn("as they are: --tessellate adds some, up to 9,000 in all", said.err)
        self.assertNotIn("tessellated", said.err)
        self.assertIn("at most", said.out)

    def test_mirrors_throw_light(self):
        light = []
        for choice in "on", "off":
            self.succeed("bake", "builtin:caustic?detail=0.25", *QUICK, "--glossy", "off", "--caustics", choice, "-o", "a.glb")
            self.succeed("render", "a.glb", *SMALL, "--env", "sky:uniform", "--no-background", "-o", "a.exr")
            light.append(self.means("a.exr", "indirect"))
        self.assertGreater(light[0]["R"], 3 * light[1]["R"], "a gold ring sends nothing but what it mirrors")
        self.assertGreater(light[0]["R"], 1.5 * light[0]["B"], "gold")

    def test_points_take_directions_until_they_are_known(self):
        command = ["bake", SCENE, *QUICK, "--directions", "8192", "--kind", "ds"]
        self.assertIsNone(self.succeed_json(*command, "-o", "a.glb")["adaptive"])
        result = self.succeed_json(*command, "--error", "0.02", "-o", "a.glb")["adaptive"]
        self.assertTrue(256 < result["mean_directions"] < result["most_directions"] <= 8192, result)
        self.assertTrue(0.002 < result["error"] <= 0.02, result)
        self.assertGreater(result["rays_saved"], 0)
        said = self.succeed(*command, "--error", "0.0001", "-o", "a.glb").err
        self.assertRegex(said, r"\d+ directions a point on average, 8192 at most: .* rays saved")
        self.assertIn("would need more than --directions", said)

    def peak_bytes(self, *arguments):
        process = subprocess.Popen([GLOAM, *arguments], cwd=self.folder, env=self.environment, stdout=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        return usage.ru_maxrss * 1024

    def test_memory_is_told_and_obeyed(self):
        command = ["bake", "builtin:cornell?detail=0.5", "--directions", "1024", "--bounce-directions", "1024", "--bounces", "3",
                   "--order", "6"]
        estimate = self.succeed_json(*command, "--estimate")
        self.assertLess(estimate["least_memory_bytes"], estimate["memory_bytes"])
        self.refuse(*command, "--memory", "20M", "-o", "a.glb", says=["--memory", "20 MiB are too little", "MiB at least"])
        for size in "", "0", "12X", "M", "-3M", "1e400":
            self.refuse(*command, f"--memory={size}", "-o", "a.glb", says="--memory")
        self.refuse("bake", "builtin:gallery", "--texels", "4096", "-o", "a.glb", says=["GiB of memory at least", "this machine has", "--texels"])
        self.assertFalse(self.path("a.glb").exists())
        program = self.peak_bytes("--version")  # with its shared libraries
        for name, cap in ("free.glb", None), ("capped.glb", estimate["least_memory_bytes"] + (4 << 20)):
            options = ["--memory", str(cap)] if cap else []
            used = self.peak_bytes(*command, *options, "--quiet", "-o", name)
            self.assertLess(used - program, cap or estimate["memory_bytes"])
            if not cap:
                self.assertGreater(used - program, estimate["memory_bytes"] / 1.6, "an estimate that is worth something")
        self.assertEqual(self.path("free.glb").read_bytes(), self.path("capped.glb").read_bytes())

    def test_a_mesh_that_is_no_surface_is_baked_where_asked_to(self):
        self.path("a.obj").write_text("""v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nv 2 0 0
f 1 2 3\nf 1 2 4\nf 1 2 5\nf 2 1 3\nf 1 2 3\nf 1 2 6\nf 3 4 5\n""")
        self.refuse("bake", "a.obj", *QUICK, "-o", "a.glb",
                    says=["a.obj: mesh", "is no manifold: 3 edges have more than two triangles", "expected two at most", "--non-manifold"])
        self.assertIn("--non-manifold bakes it", self.succeed("bake", "a.obj", "--estimate").err)
        drawn = self.succeed("render", "a.obj", *SMALL, "--technique", "prt", "--no-cache", "-o", "drawn.exr")
        self.assertIn("baked as it stands", drawn.err)
        self.succeed("bake", "a.obj", *QUICK, "--non-manifold", "-o", "a.glb")
        self.succeed("render", "a.glb", *SMALL, "--no-background", "-o", "a.exr")
        self.assertTrue(0 < self.means("a.exr")["G"] < 10)

    def test_texels_of_lightmaps(self):
        scene = "builtin:gallery?detail=0.25"
        result = self.succeed_json("bake", scene, *QUICK, "--bounces", "1", "--texels", "16", "-o", "a.glb")
        self.assertTrue(10 * 150 < result["texels"] <= 12 * 256, result)
        transfer = self.succeed_json("info", "a.glb")["transfer"]
        self.assertEqual((transfer["lightmaps"], transfer["texels"]), (12, 12 * 256))
        self.succeed("render", "a.glb", *SMALL, "--no-background", "-o", "a.exr")
        self.succeed("bake", scene, *QUICK, "--bounces", "1", "-o", "b.glb")
        self.assertEqual(self.succeed_json("info", "b.glb")["transfer"]["lightmaps"], 0)
        self.succeed("render", "b.glb", *SMALL, "--no-background", "-o", "b.exr")
        self.assertGreater(self.means("a.exr", "direct")["G"], 1.2 * self.means("b.exr", "direct")["G"],
                           "corners of the floor lie in the dark, its middle does not")
        said = self.succeed("bake", scene, *QUICK, "--texels-per-metre", "3", "--texels", "64", "--half", "-o", "c.glb").err
        self.assertIn("vertices instead of texels for 'knot', 'ball': no TEXCOORD_1; expected", said)
        self.assertIn("texels", self.succeed("bake", scene, "--texels", "16", "--estimate").out)
        self.succeed("render", "c.glb", *SMALL, "-o", "c.exr")
        self.refuse("bake", SCENE, *QUICK, "--texels", "16", "-o", "d.glb", says=["no mesh has room for texels", "'floor'", "TEXCOORD_1"])
        self.assertIn("--uv-set has no effect", self.succeed("bake", SCENE, *QUICK, "--uv-set", "1", "-o", "d.glb").err)

    def test_a_bake_of_texels_goes_on_where_it_stopped(self):
        command = ["bake", "builtin:gallery?detail=0.25", *LONG, "--texels", "48"]
        self.succeed(*command, "-o", "whole.glb")
        process = subprocess.Popen([GLOAM, *command, "-o", "a.glb"], cwd=self.folder, env=self.environment, stderr=subprocess.PIPE)
        time.sleep(1.0)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.succeed(*command, "-o", "a.glb")
        self.assertEqual(self.path("a.glb").read_bytes(), self.path("whole.glb").read_bytes())

    def test_triangles_are_split_for_shadows(self):
        scene = "builtin:gallery?detail=0.25"
        done = self.succeed("bake", scene, *QUICK, "--kind", "ds", "--tessellate", "0.1", "-o", "a.glb").err
        self.assertRegex(done, r"tessellated: [\d,]+ vertices added \([\d,]+ to [\d,]+\).* % before, .* % after")
        self.assertRegex(done.splitlines()[-1], r"--tessellate 0.1 is missed on [\d,]+ of [\d,]+ triangles, [\d.e-]+ % of the area, by up to")
        result = self.succeed_json("bake", scene, *QUICK, "--kind", "ds", "--tessellate", "0.1", "--tessellate-max", "700", "-o", "b.glb")
        split = result["tessellated"]
        self.assertTrue(split["vertices_before"] < split["vertices_after"] <= 700, split)
        self.assertGreater(split["error_before"], 0.1)
        self.assertFalse(split["bound_holds"])
        self.assertTrue(0.0 < split["area_above"] < 1.0, split)
        self.assertEqual(self.succeed_json("info", "b.glb")["vertices"], split["vertices_after"])
        self.assertIsNone(self.succeed_json("bake", scene, *QUICK, "-o", "c.glb")["tessellated"])
        self.assertIn("--tessellate-max has no effect", self.succeed("bake", scene, *QUICK, "--tessellate-max", "900", "-o", "c.glb").err)

    def test_splitting_is_bounded_in_time(self):
        command = ["bake", "builtin:gallery?detail=0.25", *QUICK, "--kind", "ds", "--tessellate", "0.02"]
        split = self.succeed_json(*command, "--tessellate-rays", "4", "-o", "a.glb")["tessellated"]
        self.assertTrue(split["out_of_rays"])
        self.assertLess(split["rays"], 12e6)
        self.assertIn("--tessellate-rays allows no more", self.succeed(*command, "--tessellate-rays", "4", "-o", "a.glb").err)

    def test_threads_do_not_change_the_bits(self):
        for name, threads in ("a.glb", 1), ("b.glb", 2):
            self.succeed("bake", SCENE, *QUICK, "--threads", threads, "-o", name)
        self.assertEqual(self.path("a.glb").read_bytes(), self.path("b.glb").read_bytes())

    def test_interrupted_bake_goes_on_and_gives_the_same_bits(self):
        command = ["bake", "builtin:cornell?detail=0.5", *LONG]
        self.assertIn("goes on", self.interrupt(*command, "-o", "a.glb", output="a.glb").splitlines()[-1])
        self.refuse(*command, "--order", "3", "-o", "a.glb", says="a.glb.checkpoint")
        resumed = self.succeed_json(*command, "-o", "a.glb")
        self.assertTrue(resumed["resumed"])
        self.assertFalse(self.path("a.glb.checkpoint").exists())
        self.succeed(*command, "-o", "b.glb")
        self.assertEqual(self.path("a.glb").read_bytes(), self.path("b.glb").read_bytes())

    def test_no_resume_starts_anew(self):
        self.path("a.glb.checkpoint").write_bytes(b"of another bake")
        self.refuse("bake", SCENE, *QUICK, "-o", "a.glb", says=["a.glb.checkpoint", "--no-resume"])
        self.assertFalse(self.succeed_json("bake", SCENE, *QUICK, "--no-resume", "-o", "a.glb")["resumed"])

    def test_a_terminal_gets_a_bar_with_time_left(self):
        try:
            main, side = pty.openpty()
        except OSError as error:  # a bare chroot without /dev/pts
            self.skipTest(f"no pseudo-terminal here: {error}")
        process = subprocess.Popen([GLOAM, "bake", "builtin:cornell?detail=0.5", *LONG, "-o", "a.glb"],
                                   cwd=self.folder, env=self.environment, stderr=side, stdin=side)
        os.close(side)
        text = b""
        try:
            while chunk := os.read(main, 4096):
                text += chunk
        except OSError:  # the terminal's other side is closed: the end
            pass
        os.close(main)
        self.assertEqual(process.wait(timeout=60), 0, text)
        self.assertRegex(text.decode(), r"\r\x1b\[K[^\r]+ \[#+\.*\] \d+ %")
        self.assertRegex(text.decode(), r"\d+ s left")

    def test_bad_options(self):
        for option, value in ("--order", 2), ("--order", 7), ("--order", "x"), ("--directions", 0), ("--directions", 1e6), \
                ("--bounces", 0), ("--bounces", 65), ("--threads", -1), ("--kind", "dx"), ("--time", "nan"), \
                ("--glossy", "yes"), ("--texels", 3), ("--texels", 4097), ("--texels-per-metre", 0), ("--texels-per-metre", "nan"), \
                ("--uv-set", 8), ("--uv-set", -1), ("--tessellate", 0), ("--tessellate", 2), ("--tessellate-max", 2), \
                ("--glossy-order", 7), ("--glossy-light-order", 2), ("--bake-gloss", 0), ("--error", 0), ("--error", 2), ("--caustics", "yes"):
            self.refuse("bake", SCENE, option, value, "-o", "a.glb", says=[option, value if value != 1e6 else "1000000"])
        for option in "--memory", "--pca", "--neighbourhood":
            self.refuse("bake", SCENE, option, "", "-o", "a.glb", says=option)

    def test_options_that_contradict_each_other(self):
        def refuse(*arguments, says):
            self.refuse("bake", SCENE, *arguments, "-o", "a.glb", says=says)
        refuse("--order", 4, "--glossy", "on", "--glossy-light-order", 5, says=["--glossy-light-order", "5 bands of light", "4 of --order"])
        refuse("--glossy-order", 3, "--glossy-light-order", 5, says=["--glossy-light-order", "5 bands of light", "3 of --glossy-order"])
        refuse("--order", 3, "--glossy-order", 5, "--glossy-light-order", 5, says=["--glossy-light-order", "3 of --order"])
        refuse("--error", 0.01, "--directions", 512, says=["--error", "--directions 512", "768 or more"])
        refuse("--kind", "du", "--tessellate", 0.1, says=["--tessellate", "no shadows"])

    def test_options_that_change_nothing_are_told(self):
        def remarks(*arguments, scene=SCENE):
            return self.succeed("bake", scene, *QUICK, *arguments, "-o", "a.glb").err
        few = ["--directions", "1024"]
        self.assertIn("--bounce-directions has no effect with --error", remarks(*few, "--error", "0.1"))
        self.assertIn("--bounce-directions are of the same set: 256", remarks("--bounce-directions", "2048"))
        self.assertIn("--non-manifold has no effect here", remarks("--non-manifold"))
        self.assertIn("--bake-gloss has no effect here: no mesh mirrors", remarks("--bake-gloss", "10"))
        self.assertNotIn("effect", remarks("--bake-gloss", "10", "--glossy", "on", "--bounces", "1"))
        self.assertIn("--bake-gloss has no effect with --glossy off", remarks("--bake-gloss", "10", "--glossy", "off"))
        self.assertIn("--time has no effect here: the scene has no animation", remarks("--time", "3"))
        self.assertIn("--tessellate-rays has no effect without --tessellate", remarks("--tessellate-rays", "3"))
        grids = remarks("--kind", "du", "--neighbourhood", "vane", "--grid", "4", scene="builtin:passing?detail=0.25")
        self.assertNotIn("--directions has no effect", grids, "grids take them")

    def test_files_and_folders_that_cannot_be_written(self):
        self.refuse("bake", SCENE, "-o", "a.png", says=".glb")
        self.refuse("bake", SCENE, "-o", "no/a.glb", says="no/a.glb")


class RenderUnbaked(CliTest):
    """Slow by nature: the default bake. The scene is small."""

    def test_prt_bakes_once_and_keeps_it(self):
        self.path("a.glb").write_bytes(spinning_triangle())
        command = ["render", "a.glb", *SMALL, "--technique", "prt"]
        first = self.succeed(*command, "-o", "a.exr")
        self.assertIn("baking it first", first.err)
        second = self.succeed(*command, "-o", "b.exr")
        self.assertIn("taken from", second.err)
        self.assertEqual(self.path("a.exr").read_bytes(), self.path("b.exr").read_bytes())
        self.assertEqual(len(list(self.path("cache/gloam/bakes").glob("*.glb"))), 1)

    def test_another_scene_gets_a_bake_of_its_own(self):
        for name, triangle_bytes in ("a.glb", spinning_triangle()), ("b.glb", spinning_triangle().replace(b"front", b"other")):
            self.path(name).write_bytes(triangle_bytes)
            self.succeed("render", name, *SMALL, "--technique", "prt", "-o", "a.png")
        self.assertEqual(len(list(self.path("cache/gloam/bakes").glob("*.glb"))), 2)

    def test_no_cache_keeps_nothing(self):
        self.path("a.glb").write_bytes(spinning_triangle())
        self.succeed("render", "a.glb", *SMALL, "--technique", "prt", "--no-cache", "-o", "a.png")
        self.assertFalse(self.path("cache/gloam").exists())

    def test_a_damaged_bake_is_made_again(self):
        self.path("a.glb").write_bytes(spinning_triangle())
        command = ["render", "a.glb", *SMALL, "--technique", "prt", "-o", "a.png"]
        self.succeed(*command)
        for kept in self.path("cache/gloam/bakes").glob("*.glb"):
            kept.write_bytes(kept.read_bytes()[:100])
        self.assertIn("baking it first", self.succeed(*command).err)


if __name__ == "__main__":
    unittest.main()
