# gloam - real-time soft global illumination
# SPDX-License-Identifier: MIT
"""The page of gloam compare in a real browser without a network: seen, clicked, dragged, read; its numbers are the files'."""
import math
import os
import sys
import time
import unittest

import browser
import exr
from compare_test import Compared

DESKTOP, PHONE = (1280, 900), (390, 844)
# What a canvas shows, through a copy: the page's own is not made for reading back.
SEEN = """window.seen = (canvas) => { const copy = new OffscreenCanvas(canvas.width, canvas.height);
    const context = copy.getContext('2d', {willReadFrequently: true}); context.drawImage(canvas, 0, 0);
    return context.getImageData(0, 0, canvas.width, canvas.height); }"""


def signal(linear):
    """sRGB, IEC 61966-2-1."""
    linear = min(max(linear, 0.0), 1.0)
    return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055


def filmic(rgb):
    """Stephen Hill's fit as src/image/tonemap.h describes it."""
    to = [(0.59719, 0.35458, 0.04823), (0.07600, 0.90834, 0.01566), (0.02840, 0.13383, 0.83777)]
    back = [(1.60475, -0.53108, -0.07367), (-0.10208, 1.10813, -0.00605), (-0.00327, -0.07276, 1.07602)]
    x = [sum(m * 1.46193 * v for m, v in zip(row, rgb)) for row in to]
    x = [(v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081) for v in x]
    return [sum(m * v for m, v in zip(row, x)) for row in back]


class Page(Compared):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.pictures = {}
        for name in ["irradiance", "prt", "prt_order=2", "reference_irradiance", "reference_prt"]:
            cls.pictures[name] = exr.read(cls.shared / "out" / f"{name}.exr")[2]

    def setUp(self):
        super().setUp()
        self.open(*DESKTOP)

    def open(self, width, height, **more):
        self.browser.events.clear()
        self.browser.view(width, height, **more)
        self.browser.open(self.shared / "out" / "index.html")
        self.browser.wait_for("document.documentElement.dataset.ready === 'yes'")
        self.evaluate(SEEN)
        self.browser.settle()

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])

    def evaluate(self, expression):
        return self.browser.evaluate(expression)

    def press(self, group, value):
        self.browser.click(f"#{group} [data-value={value}]")
        self.browser.settle()
        self.assertEqual(self.evaluate(f"document.querySelector('#{group} [aria-checked=true]').dataset.value"), value)

    def prints(self):
        """Of each picture on the stage, what tells it from another."""
        return self.evaluate("""[...document.querySelectorAll('#stage canvas')].map((canvas) => {
            const data = new Uint32Array(seen(canvas).data.buffer);
            let sum = 0; for (let i = 0; i < data.length; ++i) sum = (Math.imul(sum, 31) + data[i]) | 0; return sum; })""")

    def point(self, pane, x, y):
        """Where pixel x, y of a whole picture stands in the window."""
        cx, cy = self.browser.center(f"#stage figure:nth-child({pane + 1}) canvas")
        width, height = self.evaluate(f"(() => {{ const b = document.querySelectorAll('#stage canvas')[{pane}].getBoundingClientRect(); return [b.width, b.height]; }})()")
        return cx + ((x + 0.5) / 40 - 0.5) * width, cy + ((y + 0.5) / 32 - 0.5) * height

    def inspected(self):
        """{label: [R, G, B, error]}: numbers, and the error as it reads."""
        rows = self.evaluate("""[...document.querySelectorAll('#inspector tbody tr')].map((row) =>
            [row.cells[0].textContent, ...[1, 2, 3].map((i) => Number(row.cells[i].dataset.value)), row.cells[4].textContent])""")
        return {row[0]: row[1:] for row in rows}

    def column(self, key):
        return self.evaluate(f"[...document.querySelectorAll('#measures td[data-key={key}]')].map((cell) => cell.dataset.value)")

    def labels(self):
        return self.evaluate("[...document.querySelectorAll('#measures .expander')].map((button) => button.textContent)")

    # ---- What is seen ----------------------------------------------------------------------------------------------------

    def test_every_picture_decodes(self):
        labels = self.evaluate("[...document.querySelectorAll('#stage figcaption > :first-child')].map((e) => e.textContent)")
        self.assertEqual(labels[:3], ["irradiance", "prt", "prt order=2"])
        self.assertIn("Reference for prt", labels)
        self.assertIn("Reference for irradiance", labels)
        prints = self.prints()
        self.assertEqual(len(prints), len(labels))
        self.assertEqual(len(set(prints)), len(prints), "two pictures are one")
        shades = self.evaluate("""[...document.querySelectorAll('#stage canvas')].map((canvas) =>
            new Set(new Uint32Array(seen(canvas).data.buffer)).size)""")
        self.assertGreater(min(shades), 50)

    def test_title_and_words(self):
        self.assertEqual(self.evaluate("document.getElementById('title').textContent"), "box")
        text = self.evaluate("document.body.innerText")
        for words in "box.glb", "40 × 32 pixels", "1 bounce", self.results["device"], "complete in itself":
            self.assertIn(words, text)
        for technique in self.results["techniques"]:
            self.assertIn(technique["command"], text)

    def test_values_under_the_cursor(self):
        files = {"irradiance": "irradiance", "prt": "prt", "prt order=2": "prt_order=2", "Reference for prt": "reference_prt",
                 "Reference for irradiance": "reference_irradiance"}
        for layer, prefix in ("direct", "direct."), ("indirect", "indirect."), ("sum", ""):
            self.press("layer-choice", layer)
            for x, y in (20, 16), (7, 25), (33, 5):
                self.browser.mouse("mouseMoved", *self.point(1, x, y))
                self.browser.settle()
                self.assertIn(f"{x}, {y}", self.evaluate("document.getElementById('inspector-place').textContent"))
                shown = self.inspected()
                for label, name in files.items():
                    for c, value in zip("RGB", shown[label]):
                        wanted = self.pictures[name][prefix + c][y * 40 + x]
                        slack = 0 if prefix else 2e-3 * abs(wanted) + 1e-6  # the sum is made of two halves
                        self.assertAlmostEqual(value, wanted, delta=slack, msg=f"{label} {layer} {x},{y}")
                a, b = shown["prt"][:3], shown["Reference for prt"][:3]
                norm = math.sqrt(sum(v * v for v in b))
                if norm > 0:
                    error = math.sqrt(sum((p - q) ** 2 for p, q in zip(a, b))) / norm
                    self.assertAlmostEqual(float(shown["prt"][3].strip("▲▼ %")) / 100, error, delta=0.05 * error + 1e-9)

    def test_colours_are_those_of_the_tone_curve(self):
        x, y = 20, 16
        self.browser.mouse("mouseMoved", *self.point(1, x, y))
        self.browser.click("#stage figure:nth-child(2) canvas")
        for _ in range(12):
            self.browser.press("+", "Equal", "+")
        self.browser.settle()
        stops = float(self.evaluate("document.getElementById('exposure').value"))
        for curve in "filmic", "linear":
            self.press("curve-choice", curve)
            for label, pane, name in ("prt", 1, "prt"), ("Reference for prt", None, "reference_prt"):
                index = pane if pane is not None else self.evaluate(
                    "[...document.querySelectorAll('#stage figcaption > :first-child')].findIndex((e) => e.textContent === 'Reference for prt')")
                at = [int(v) for v in self.evaluate("document.getElementById('inspector-place').textContent.match(/\\d+/g).slice(0, 2)")]
                got = self.evaluate(f"""(() => {{ const pane = document.querySelectorAll('#stage .pane')[{index}], canvas = pane.querySelector('canvas');
                    const a = pane.getBoundingClientRect(), b = pane.querySelector('.probe').getBoundingClientRect(), k = canvas.width / a.width;
                    const x = (b.left + b.width / 2 - a.left) * k, y = (b.top + b.height / 2 - a.top) * k;
                    const at = 4 * (Math.floor(y) * canvas.width + Math.floor(x));
                    return [...seen(canvas).data.slice(at, at + 4)]; }})()""")
                radiance = [max(self.pictures[name][f"direct.{c}"][at[1] * 40 + at[0]] + self.pictures[name][f"indirect.{c}"][at[1] * 40 + at[0]], 0)
                            * 2 ** stops for c in "RGB"]
                wanted = [255 * signal(v) for v in (filmic(radiance) if curve == "filmic" else radiance)]
                for g, w in zip(got, wanted):
                    self.assertAlmostEqual(g, w, delta=1.01, msg=f"{label} {curve} {got} {wanted}")

    # ---- What is clicked and dragged -----------------------------------------------------------------------------------------

    def test_light_exposure_and_curve_change_the_pictures(self):
        seen = [self.prints()]
        self.press("layer-choice", "direct")
        seen.append(self.prints())
        self.press("layer-choice", "indirect")
        seen.append(self.prints())
        self.press("layer-choice", "sum")
        self.assertEqual(self.prints(), seen[0])
        self.press("curve-choice", "linear")
        seen.append(self.prints())
        self.evaluate("(() => { const e = document.getElementById('exposure'); e.value = Number(e.value) + 1; e.dispatchEvent(new Event('input')); })()")
        self.browser.settle()
        seen.append(self.prints())
        for i, one in enumerate(seen):
            for other in seen[:i]:
                self.assertNotEqual(one[1], other[1])

    def test_slider_between_two_pictures(self):
        self.press("view-choice", "swipe")
        self.assertEqual(len(self.prints()), 1)
        at = self.browser.center(".divider")
        middle = self.prints()
        box = self.evaluate("(() => { const b = document.querySelector('#stage .pane').getBoundingClientRect(); return [b.left, b.right]; })()")
        self.browser.drag(at, (box[0] + 2, at[1]))
        self.browser.settle()
        self.assertLess(int(self.evaluate("document.querySelector('.divider').getAttribute('aria-valuenow')")), 3)
        self.browser.evaluate("document.querySelector('.divider').focus()")
        self.browser.press("Home")
        self.browser.settle()
        right = self.prints()
        self.browser.press("End")
        self.browser.settle()
        left = self.prints()
        self.assertEqual(len({middle[0], left[0], right[0]}), 3)
        self.evaluate("(() => { const e = document.getElementById('swipe-right'); e.value = document.getElementById('swipe-left').value; e.dispatchEvent(new Event('change')); })()")
        self.browser.settle()
        self.assertEqual(self.prints(), left, "one picture on both sides is that picture")

    def test_differences(self):
        self.press("view-choice", "difference")
        seen = []
        for kind in "difference", "false", "flip":
            self.press("difference-choice", kind)
            prints = self.prints()
            self.assertEqual(len(prints), 3)
            self.assertEqual(len(set(prints)), 3)
            self.assertNotIn(prints[0], seen)
            seen.append(prints[0])
        self.press("difference-choice", "difference")
        self.evaluate("(() => { const e = document.getElementById('factor'); e.value = '8'; e.dispatchEvent(new Event('change')); })()")
        self.browser.settle()
        self.assertNotIn(self.prints()[0], seen)

    def test_zoom_and_pan_are_linked(self):
        whole = self.prints()
        x, y = self.point(0, 10, 10)
        time.sleep(0.4)  # a page that has just scrolled lets the wheel scroll on
        for _ in range(6):
            self.browser.mouse("mouseWheel", x, y, deltaX=0, deltaY=-120)
        self.browser.settle()
        near = self.prints()
        self.assertTrue(all(a != b for a, b in zip(whole, near)))
        self.assertIn(" 10, 10 ", self.evaluate("document.getElementById('inspector-place').textContent"), "the wheel keeps the pixel under it")
        self.browser.drag((x, y), (x + 30, y + 20))
        self.browser.settle()
        self.assertTrue(all(a != b for a, b in zip(near, self.prints())))
        self.browser.click("#zoom-fit")
        self.browser.settle()
        self.assertEqual(self.prints(), whole)

    def test_keyboard(self):
        self.browser.mouse("mouseMoved", *self.point(0, 10, 10))
        self.evaluate("document.querySelector('#stage canvas').focus()")
        for key in "ArrowRight", "ArrowRight", "ArrowDown":
            self.browser.press(key)
        self.assertIn(" 12, 11 ", self.evaluate("document.getElementById('inspector-place').textContent"))
        self.assertIn("12, 11", self.evaluate("document.getElementById('spoken').textContent"))
        self.evaluate("document.querySelector('#layer-choice [aria-checked=true]').focus()")
        self.browser.press("ArrowRight")
        self.assertEqual(self.evaluate("document.querySelector('#layer-choice [aria-checked=true]').dataset.value"), "direct")

    def test_reachable_and_named(self):
        nameless = self.evaluate("""[...document.querySelectorAll('button, select, input, canvas[tabindex], [role=slider]')].filter((e) => e.offsetParent
            && !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length)).map((e) => e.outerHTML)""")
        self.assertEqual(nameless, [])
        for label in self.evaluate("[...document.querySelectorAll('#stage canvas')].map((e) => e.getAttribute('aria-label'))"):
            self.assertIn("all light", label)

    # ---- Table and plot ----------------------------------------------------------------------------------------------------

    def test_table_holds_the_results_and_sorts(self):
        by_label = {technique["label"]: technique for technique in self.results["techniques"]}
        for layer in "direct", "indirect", "sum":
            self.press("layer-choice", layer)
            labels = self.labels()
            self.assertEqual(set(labels), set(by_label))
            for key in "rmse", "relative_squared_error", "psnr", "ssim", "flip", "mean_signed_error", "device_ms", "memory_bytes", "bake_seconds":
                for label, shown in zip(labels, self.column(key)):
                    technique = by_label[label]
                    wanted = technique.get(key) if layer == "sum" or key in ("device_ms", "memory_bytes", "bake_seconds") else technique[layer][key]
                    self.assertEqual(None if shown is None else float(shown), wanted, f"{layer} {label} {key}")
        errors = [float(value) for value in self.column("relative_squared_error")]
        self.assertEqual(errors, sorted(errors))
        for key, down in ("psnr", True), ("device_ms", False):
            self.browser.click(f"[data-sort={key}]")
            values = [float(value) for value in self.column(key)]
            self.assertEqual(values, sorted(values, reverse=down))
            self.browser.click(f"[data-sort={key}]")
            values = [float(value) for value in self.column(key)]
            self.assertEqual(values, sorted(values, reverse=not down))
            self.assertEqual(self.evaluate(f"document.querySelector('th[data-key={key}]').getAttribute('aria-sort')"), "ascending" if down else "descending")

    def test_passes_open(self):
        self.browser.click(".expander")
        text = self.evaluate("document.querySelector('.details').innerText")
        label = self.labels()[0]
        technique = next(t for t in self.results["techniques"] if t["label"] == label)
        for entry in technique["passes"]:
            self.assertIn(entry["name"], text)
        self.browser.click(".expander")
        self.assertIsNone(self.evaluate("document.querySelector('.details')"))

    def test_plot(self):
        points = self.evaluate("""[...document.querySelectorAll('#plot g[data-technique]')].map((g) =>
            [Number(g.dataset.technique), ...['cx', 'cy'].map((a) => Number(g.querySelector('circle').getAttribute(a)))])""")
        self.assertEqual(sorted(point[0] for point in points), [0, 1, 2])
        techniques = self.results["techniques"]
        by_time = [p[0] for p in sorted(points, key=lambda p: p[1])]
        self.assertEqual([techniques[i]["device_ms"] for i in by_time], sorted(t["device_ms"] for t in techniques))
        by_error = [p[0] for p in sorted(points, key=lambda p: -p[2])]
        self.assertEqual([techniques[i]["relative_squared_error"] for i in by_error], sorted(t["relative_squared_error"] for t in techniques))

    def test_noise_is_each_technique_s_own(self):
        techniques = self.results["techniques"]
        hidden = [t for t in techniques if math.sqrt(t["relative_squared_error"]) < 1.5 * t["reference_noise"]]
        headline = self.evaluate("document.getElementById('headline').textContent")
        self.assertEqual("Not clearly off by more than the noise" in headline, bool(hidden), headline)
        for technique in hidden:
            self.assertIn(f"{technique['label']} (", headline)
        points = self.evaluate("""[...document.querySelectorAll('#plot g[data-technique]')].map((g) =>
            [Number(g.dataset.technique), ...['cx', 'cy'].map((a) => Number(g.querySelector('circle').getAttribute(a)))])""")
        dashes = self.evaluate("""[...document.querySelectorAll('#plot .floor')].map((line) =>
            [line.textContent, ...['x1', 'x2', 'y1'].map((a) => Number(line.getAttribute(a)))])""")
        self.assertTrue(dashes)
        self.assertIn("Dashed: what the noise of", self.evaluate("document.getElementById('plot-caption').textContent"))
        for text, left, right, at in dashes:
            [(index, _, dot)] = [p for p in points if text.startswith(f"noise of what {techniques[p[0]]['label']} is held to")]
            self.assertTrue(left <= points[[p[0] for p in points].index(index)][1] <= right)
            technique = techniques[index]
            self.assertEqual(at > dot, technique["reference_noise"] < math.sqrt(technique["relative_squared_error"]))

    # ---- Other screens -------------------------------------------------------------------------------------------------------

    def test_on_a_phone(self):
        self.open(*PHONE, scale=2, phone=True)
        for view in "grid", "swipe", "difference":
            self.press("view-choice", view)
            self.assertLessEqual(self.evaluate("document.documentElement.scrollWidth"), PHONE[0], view)
        self.press("view-choice", "grid")
        self.browser.click(".expander")
        self.assertLessEqual(self.evaluate("document.documentElement.scrollWidth"), PHONE[0])
        whole = self.prints()
        x, y = self.point(0, 20, 16)
        self.browser.touch("touchStart", (x - 10, y), (x + 10, y))
        for step in range(1, 6):
            self.browser.touch("touchMove", (x - 10 - 8 * step, y), (x + 10 + 8 * step, y))
        self.browser.touch("touchEnd")
        self.browser.settle()
        self.assertTrue(all(a != b for a, b in zip(whole, self.prints())), "two fingers zoom")
        self.browser.click("#zoom-fit")
        x, y = self.point(1, 7, 9)
        self.browser.touch("touchStart", (x, y))
        self.browser.touch("touchEnd")
        self.assertIn(" 7, 9 ", self.evaluate("document.getElementById('inspector-place').textContent"))

    def test_dark(self):
        light = self.evaluate("getComputedStyle(document.body).backgroundColor")
        self.open(*DESKTOP, dark=True)
        self.assertNotEqual(self.evaluate("getComputedStyle(document.body).backgroundColor"), light)


if __name__ == "__main__":
    if browser.find() is None:
        sys.exit("chromium is not installed: tools/setup test")
    if not os.path.exists("/proc/self"):
        print("SKIPPED: chromium does not start without /proc")
        sys.exit(77)
    unittest.main()
