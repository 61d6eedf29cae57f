# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""examples/three in a real browser: a bake relit by its JavaScript reader gives what the plain C++ reader gives, and turns.

Skipped where Chromium cannot start, or where three.js is not there and npm cannot fetch it.
"""
import os
import shutil
import subprocess
import sys
import unittest

import browser
from harness import SOURCE, CliTest

QUICK = ["--directions", "256", "--bounce-directions", "256", "--glossy", "off"]
FILES = {"float": [], "half": ["--half"], "pca": ["--pca", "8x12"], "pca_half": ["--pca", "4x8", "--half"]}
WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def missing():
    """Why the page cannot be shown, or None."""
    if not browser.find():
        return "chromium is not installed"
    if (SOURCE / "assets/three/three.module.min.js").exists():
        return None
    if not shutil.which("npm"):
        return "npm is not installed"
    done = subprocess.run([SOURCE / "tools/get-assets", "three"], capture_output=True, text=True, check=False)
    return None if done.returncode == 0 else "three.js could not be fetched: " + done.stderr.strip()[:200]


class Page(CliTest):
    @classmethod
    def setUpClass(cls):
        browser.Browser.FLAGS = [flag for flag in browser.Browser.FLAGS if flag != "--disable-gpu"] + WEBGL
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.browser.close)

    def open(self, name):
        done = subprocess.run([sys.executable, SOURCE / "examples/three/make_page.py", self.path(f"{name}.glb"),
                               self.path(f"{name}.html")], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.browser.events.clear()
        self.browser.view(480, 360)
        self.browser.open(self.path(f"{name}.html"))
        self.browser.wait_for("document.documentElement.dataset.ready")
        return self.browser.evaluate("document.documentElement.dataset.ready")

    def pixels(self):
        """Mean of what the canvas shows, and how many of its pixels differ from the first one."""
        return self.browser.evaluate("""(() => { const from = document.querySelector('canvas');
            const copy = new OffscreenCanvas(from.width, from.height), context = copy.getContext('2d');
            context.drawImage(from, 0, 0);
            const data = context.getImageData(0, 0, from.width, from.height).data;
            let sum = 0, other = 0;
            for (let i = 0; i < data.length; i += 4) { sum += data[i + 1];
                if (Math.abs(data[i + 1] - data[1]) > 8) ++other; }
            return [sum / (data.length / 4), other / (data.length / 4)]; })()""")

    def test_readers_agree(self):
        for name, options in FILES.items():
            with self.subTest(name):
                self.succeed("bake", "builtin:columns?detail=0.3", *QUICK, "--bounces", "1", "--order", "4", *options, "-o", f"{name}.glb")
                subprocess.run([os.environ["READER"], self.path(f"{name}.glb"), "1", "2", "0.5", self.path("a.ply")], check=True)
                lines = self.path("a.ply").read_text().split("end_header\n")[1].splitlines()
                want = [[float(v) for v in line.split()[3:]] for line in lines]
                self.assertEqual(self.open(name), "yes")
                got = self.browser.evaluate("""import('relight').then(({lightOf}) => relit.lit.flatMap((part) => {
                    const n = Math.hypot(1, 2, 0.5), light = lightOf(part.order, [1 / n, 2 / n, 0.5 / n], [1, 1, 1], [0.3, 0.3, 0.3]);
                    return Array.from(part.transfer.irradiance(light)); }))""")
                self.assertEqual(len(got), 3 * len(want))
                worst = max(abs(g - w) for g, w in zip(got, (v for row in want for v in row)))
                self.assertLess(worst, 1e-4)
                self.assertEqual(self.browser.complaints(), [])

    def test_the_lamp_turns_and_the_model_is_seen(self):
        self.succeed("bake", "builtin:spheres?detail=0.4", "--kind", "ds", *QUICK[:2], "--glossy", "off", "--pca", "16x8", "--half", "-o", "a.glb")
        self.assertEqual(self.open("a"), "yes")
        mean, other = self.pixels()
        self.assertGreater(other, 0.1, "nothing is seen")
        before = self.browser.evaluate("Array.from(relit.lit[0].irradiance)")
        self.browser.evaluate("document.getElementById('azimuth').value = 140; relit.turnLight()")
        after = self.browser.evaluate("Array.from(relit.lit[0].irradiance)")
        self.assertGreater(max(abs(a - b) for a, b in zip(before, after)), 0.3)
        self.assertNotAlmostEqual(self.pixels()[0], mean, delta=0.5)
        x, y = 300, 100
        self.browser.drag((x, y), (x + 60, y))
        if os.environ.get("GLOAM_KEEP_SCREENSHOT"):
            self.browser.screenshot(os.environ["GLOAM_KEEP_SCREENSHOT"])
        self.assertEqual(self.browser.complaints(), [])

    def test_metals_are_said_to_be_left_out(self):
        about = "document.getElementById('about').textContent"
        self.succeed("bake", "builtin:ring?detail=0.3", "--kind", "ds", *QUICK[:2], "--glossy", "off", "-o", "a.glb")
        self.assertEqual(self.open("a"), "yes")
        self.assertIn("Not shown here: what metals mirror (they are black)", self.browser.evaluate(about))
        self.succeed("bake", "builtin:columns?detail=0.3", "--kind", "ds", *QUICK[:2], "--glossy", "off", "-o", "b.glb")
        self.assertEqual(self.open("b"), "yes")
        self.assertNotIn("Not shown", self.browser.evaluate(about))

    def test_what_it_cannot_read_is_said(self):
        self.succeed("scene", "spheres?detail=0.3", "-o", "a.glb")
        self.assertEqual(self.open("a"), "no")
        self.assertIn("no baked transfer", self.browser.evaluate("document.getElementById('about').textContent"))


if __name__ == "__main__":
    why = missing()
    if not why:
        try:
            browser.Browser().close()
        except (OSError, RuntimeError, TimeoutError) as error:
            why = f"chromium cannot start: {error}"
    if why:
        print("SKIPPED:", why)
        sys.exit(77)
    unittest.main()
