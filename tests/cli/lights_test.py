# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""--light: distant lights as shapes, several, moving, in every verb that lights a scene."""
import json
import unittest

from harness import BOX, SMALL, CliTest

BALL = "builtin:furnace?detail=0.4"


class Lights(CliTest):
    def render(self, *lights, more=()):
        """Mean green of the picture without its background."""
        options = [word for light in lights for word in ("--light", light)]
        self.succeed("render", BALL, *SMALL, "--env", "none", "--no-background", *options, *more, "-o", "a.exr")
        return self.means("a.exr")["G"]

    def test_several_add_up(self):
        disc, constant = "disc?elevation=60&radius=20", "constant?radiance=0.2"
        both = self.render(disc, constant, more=["--irradiance.window", "none"])
        alone = self.render(disc, more=["--irradiance.window", "none"]) + self.render(constant, more=["--irradiance.window", "none"])
        self.assertAlmostEqual(both, alone, delta=0.005 * both)

    def test_no_other_light_where_a_light_is_given(self):
        result = self.succeed("render", BOX, *SMALL, "--light", "constant", "-o", "a.png")
        self.assertNotIn("sky:mild", result.err)

    def test_added_to_the_environment_and_named(self):
        lit = self.succeed_json("render", BALL, *SMALL, "--env", "sky:overcast", "--light", "disc?radius=9", "-o", "a.exr")
        self.assertEqual(lit["environment"], "sky:overcast + disc?radius=9")

    def test_keys_move_it(self):
        moving = "constant?radiance=0:0.1,2:0.9"
        self.succeed("render", BALL, *SMALL, "--env", "none", "--light", moving, "--animate", "0:2", "--fps", "2", "-o", "a_####.exr")
        means = [self.means(f"a_{i:04}.exr")["R"] for i in range(4)]
        for i, radiance in enumerate([0.1, 0.3, 0.5, 0.7]):  # seen behind the ball, and on it as a furnace shows it
            self.assertAlmostEqual(means[i], radiance, delta=0.02 * radiance + 0.002)
        self.succeed("render", BALL, *SMALL, "--env", "none", "--light", moving, "--time", "1", "-o", "b.exr")
        self.assertAlmostEqual(self.means("b.exr")["R"], means[2], delta=1e-3)

    def test_file_of_lights(self):
        self.path("lights.json").write_text(json.dumps(["disc?elevation=60&radius=20", "constant?radiance=0.2"]))
        self.assertAlmostEqual(self.render("lights.json"), self.render("disc?elevation=60&radius=20", "constant?radiance=0.2"), delta=1e-4)

    def test_reference_sees_the_same(self):
        light = ["--light", "disc?elevation=50&azimuth=30&radius=4&irradiance=2"]
        view = [*SMALL, "--env", "none", "--no-background", *light]
        self.succeed("render", BALL, *view, "--irradiance.window", "none", "-o", "a.exr")
        self.succeed("reference", BALL, *view, "--bounces", "0", "--spp", "64", "-o", "b.exr")
        truth = self.means("b.exr")["G"]
        self.assertAlmostEqual(self.means("a.exr")["G"], truth, delta=0.06 * truth)
        result = self.succeed_json("compare", BALL, *SMALL, *light, "--techniques", "irradiance", "--spp", "16", "--frames", "1", "--bounces", "0", "-o", "out")
        self.assertIn("disc?elevation=50", result["environment"])

    def test_bad_ones_get_one_line(self):
        for light, words in {"disk": ["disk", "no such light"], "disc?radius=0": ["radius"], "disc?azimuth=2:1,1:2": ["ascend"],
                             "probe:none.exr": ["none.exr"], "none.json": ["none.json"], "disc?irradiance=1&radiance=1": ["exclude"],
                             "sky:preetham?elevation=0:3,4:100": ["elevation"]}.items():
            self.refuse("render", BALL, *SMALL, "--light", light, "-o", "a.png", says=words)
        self.path("bad.json").write_text("{}")
        self.refuse("reference", BALL, *SMALL, "--light", "bad.json", "-o", "a.exr", says=["bad.json", "list"])
        self.path("bad.json").write_text('["constant", ["constant"]]')
        self.refuse("reference", BALL, *SMALL, "--light", "bad.json", "-o", "a.exr", says=["bad.json", "entry 1 is an array"])


if __name__ == "__main__":
    unittest.main()
