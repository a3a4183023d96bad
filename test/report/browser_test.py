"""The page of `sixdof report` in a real browser: every figure draws without a console error, choices work, a phone has no
sideways scroll, hostile names stay text.

usage: browser_test.py SIXDOF [FOLDER FOR SCREENSHOTS]

Exits with 77 (a skipped test) where Chromium or the page's libraries are missing.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from browser import Browser, find_chromium  # noqa: E402
from sample_results import HOSTILE, STRESS, cast_rows, collection, contact_rows, rows, scene_rows  # noqa: E402

SIXDOF = sys.argv.pop(1)
SHOTS = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else None
CHROMIUM = find_chromium()
SKIPPED = 77


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.folder.name)
        cls.page = folder / "report.html"
        context = {"date": "2026-01-02T03:04:05+00:00", "commit": HOSTILE, "seed": "1", "sample": "64", "mesh:torus-1k": "0123",
                   "algorithm:exact": "1", "settings:exact": "warm_start=off"}
        (folder / "run.json").write_text(json.dumps({"context": context, "benchmarks": rows()}))
        (folder / "scenes.json").write_text(json.dumps({"context": {}, "benchmarks": [*scene_rows(), *cast_rows(), *contact_rows()]}))
        (folder / "objects.json").write_text(json.dumps({"context": {}, "benchmarks": [], **collection()}))
        (folder / "later.json").write_text(json.dumps({"context": context, "benchmarks": rows(1.3)}))
        environment = os.environ | {"SIXDOF_CACHE": str(folder / "cache")}
        mesh = folder / "a.off"
        subprocess.run([SIXDOF, "models", "make", "torus-1k", "-o", str(mesh)], check=True, capture_output=True, env=environment)
        real = {"family": "kissing", "algorithm": "ode", "verdict": "wrong", "cases": 1, "worst": 1.0, "unit": "size", "case": "x", "words": "",
                "reproduction": f'sixdof query --a {mesh} --b {mesh} --pose "0.5 0 0 1 0 0 0" --algorithm ode'}
        (folder / "stress.json").write_text(json.dumps([*STRESS, real]))
        subprocess.run([SIXDOF, "quality", "--scenario", "II", "--algorithm", "vps", "-p", "voxel_size=0.05", "-p", "point_spacing=0.05",
                        "--steps", "128", "-o", str(folder / "II.h5")], check=True, capture_output=True, env=environment)
        done = subprocess.run([SIXDOF, "report", *(str(folder / name) for name in ("run.json", "later.json", "stress.json", "scenes.json", "objects.json")), "--series",
                               str(folder / "II.h5"), "-o", str(cls.page)], capture_output=True, text=True, check=False, env=environment)
        if done.returncode != 0 and "cmake/setup report" in done.stderr:
            print("skipped:", done.stderr)
            sys.exit(SKIPPED)
        assert done.returncode == 0, done.stderr
        cls.plain = folder / "plain.html"
        subprocess.run([SIXDOF, "report", str(folder / "run.json"), "-o", str(cls.plain)], check=True, capture_output=True, env=environment)
        cls.browser = Browser(CHROMIUM)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.folder.cleanup()

    def setUp(self):
        self.browser.errors.clear()

    def open(self, width=1200, dark=False, page=None):
        self.browser.call("Page.navigate", url="about:blank")
        self.browser.window(width, 900, dark)
        self.browser.open(page or self.page)
        self.browser.wait_for("!!sixdofReport.ready")

    def pages(self):
        return self.browser.run("sixdofReport.data.pages.map(page => page.id)")

    def go_to(self, page):
        self.browser.run(f"location.hash = {json.dumps(page)}")
        self.browser.wait_for(f"sixdofReport.ready === {json.dumps(page)}")

    def shot(self, name):
        if SHOTS:
            SHOTS.mkdir(parents=True, exist_ok=True)
            self.browser.screenshot(SHOTS / f"{name}.png")

    def test_every_figure_draws_without_a_console_error(self):
        for dark in (False, True):
            self.open(dark=dark)
            for page in self.pages():
                self.go_to(page)
                cards = self.browser.run("[...document.querySelectorAll('.figure[data-drawn]')].map(f => f.id.slice(7)).filter(id => id !== 'view')")
                for figure in cards:
                    marks = self.browser.run(f"document.querySelectorAll('#figure-{figure} .plot svg .mark-group path, #figure-{figure} .plot svg .mark-text text').length")
                    self.assertGreater(marks, 0, f"{page}: {figure}")
                self.assertNotIn("[object", self.browser.run("[...document.querySelectorAll('h3')].map(title => title.textContent).join()"), page)
                self.shot(f"{page}-{'dark' if dark else 'light'}")
        self.assertEqual(self.browser.errors, [])

    def test_pages_have_their_figures_from_this_data(self):
        self.open()
        drawn = []
        for page in self.pages():
            self.go_to(page)
            drawn += self.browser.run("[...document.querySelectorAll('.figure')].filter(f => Number(f.dataset.drawn) > 0).map(f => f.id)")
        figures = self.browser.run("Object.keys(sixdofReport.data.figures)")
        wanted = [figure for figure in figures if figure != "history"]  # sixdof history makes that one
        self.assertEqual(sorted(drawn), sorted("figure-" + name for name in [*wanted, "view"]))

    def test_every_page_of_one_run_is_filled_or_names_its_command(self):
        self.open(page=self.plain)
        named = {}
        for page in self.pages():
            self.go_to(page)
            is_filled = self.browser.run("document.querySelectorAll('main .plot svg, main table tbody tr, main .sentences p, main canvas').length > 0")
            command = self.browser.run("document.querySelector('main .empty .command code')?.textContent ?? null")
            self.assertTrue(is_filled or command, page)
            self.assertFalse(is_filled and command, page)
            if command:
                named[page] = command.split()[0]
        self.assertEqual(named, {"signals": "sixdof", "scenes": "bench/run", "deforming": "bench/run", "collection": "bench/scripts/collection", "stability": "sixdof", "compare": "sixdof",
                                 "history": "sixdof", "casts": "bench/run", "contacts": "sixdof-bench", "depths": "sixdof-bench"})
        self.go_to("summary")
        self.assertIn("sixdof stress", self.browser.run("document.querySelector('main .verdict .command code').textContent"))

    def test_hostile_names_are_text(self):
        self.open()
        for page in self.pages():
            self.go_to(page)
            self.assertEqual(self.browser.run("document.querySelectorAll('main img:not(.pictures img), main script').length"), 0, page)
        self.assertIsNone(self.browser.run("window.hacked ?? null"))
        self.go_to("failures")
        self.assertIn(HOSTILE, self.browser.run("document.querySelector('main').textContent"))

    def test_choices_and_algorithms_change_the_figure(self):
        self.open()
        self.go_to("speed")
        card = "document.querySelector('#figure-time_distance')"
        before = self.browser.run(f"{card}.dataset.drawn")
        lines = f"{card}.querySelectorAll('.plot svg .mark-line path').length"
        self.assertEqual(self.browser.run(lines), 4)
        self.browser.run(f"{card}.querySelector('.chips input').click()")
        self.browser.wait_for(f"{lines} === 3")
        self.assertLess(int(self.browser.run(f"{card}.dataset.drawn")), int(before))
        self.assertIn("1 algorithm is switched off", self.browser.run(f"{card}.querySelector('.missing').textContent"))
        self.browser.run(f"""(() => {{ const select = [...{card}.querySelectorAll('select')].find(s => s.textContent.includes('longest'));
            select.value = 'longest'; select.dispatchEvent(new Event('change')); }})()""")
        self.browser.wait_for("[...document.querySelectorAll('#figure-time_distance select')].some(s => s.value === 'longest')")
        self.browser.wait_for(f"{lines} === 3")

    def key(self, key, code, number, text=""):
        for kind in ("keyDown", "keyUp"):
            more = {"text": text} if text and kind == "keyDown" else {}
            self.browser.call("Input.dispatchKeyEvent", type=kind, key=key, code=code, windowsVirtualKeyCode=number, **more)

    def figures(self):
        return self.browser.run("[...document.querySelectorAll('.figure[data-drawn]')].map(f => f.id).filter(id => id !== 'figure-view')")

    def test_every_filter_of_every_figure_draws_each_of_its_values(self):
        self.open()
        tried = 0
        for page in self.pages():
            self.go_to(page)
            for figure in self.figures():
                tried += self.browser.run(f"""(async () => {{ const card = sixdofReport.cards[{json.dumps(figure[7:])}]; let tried = 0;
                    for (const {{ filter }} of card.shown().resolved) {{
                      const first = card.choices[filter.field];
                      for (const value of card.shown().resolved.find(r => r.filter.field === filter.field).values.slice(0, 6)) {{
                        card.choices[filter.field] = value;
                        await card.draw();
                        const shown = card.shown();
                        if (String(shown.choices[filter.field]) !== String(value)) throw new Error(card.meta.id + ' has not ' + value);
                        if (!filter.field.startsWith('axis') && value !== 'all' && shown.rows.some(row => row[filter.field] !== value)) throw new Error(card.meta.id + ' shows others');
                        ++tried;
                      }}
                      card.choices[filter.field] = first;
                    }} return tried; }})()""")
        self.assertGreater(tried, 80)
        self.assertEqual(self.browser.errors, [])

    def test_keyboard_toggles_and_filters_in_every_figure(self):
        self.open()
        toggled, filtered = [], []
        for page in self.pages():
            self.go_to(page)
            for figure in self.figures():
                card = f"document.querySelector('#{figure}')"
                if self.browser.run(f"{card}.querySelectorAll('.chips input').length") > 1:
                    before = self.browser.run(f"{card}.dataset.drawn")
                    self.browser.run(f"{card}.querySelectorAll('.chips input')[1].focus()")
                    self.key(" ", "Space", 32, " ")
                    self.browser.wait_for(f"{card}.dataset.drawn !== {json.dumps(before)}")
                    self.assertLess(int(self.browser.run(f"{card}.dataset.drawn")), int(before), figure)
                    self.key(" ", "Space", 32, " ")  # the focus stays on it
                    self.browser.wait_for(f"{card}.dataset.drawn === {json.dumps(before)}")
                    toggled.append(figure[7:])
                if self.browser.run(f"!!{card}.querySelector('.controls select')"):
                    value = self.browser.run(f"{card}.querySelector('.controls select').value")
                    self.browser.run(f"{card}.querySelector('.controls select').focus()")
                    is_last = self.browser.run(f"(select => select.selectedIndex + 1 === select.length)({card}.querySelector('.controls select'))")
                    self.key(*(("ArrowUp", "ArrowUp", 38) if is_last else ("ArrowDown", "ArrowDown", 40)))
                    self.browser.wait_for(f"{card}.querySelector('.controls select').value !== {json.dumps(value)}")
                    self.assertTrue(self.browser.run(f"document.activeElement === {card}.querySelector('.controls select')"), figure)
                    filtered.append(figure[7:])
        for figure in ("time_distance", "time_volume", "response_errors", "scenario_measures", "frontier", "metrics", "equal_time", "update_rates",
                       "many_bodies", "collection", "growth"):
            self.assertIn(figure, toggled)
        for figure in ("winners", "time_distance", "response_errors", "scenario_measures", "signals", "spectra", "frontier", "metrics", "many_bodies"):
            self.assertIn(figure, filtered)
        self.assertEqual(self.browser.errors, [])

    def test_any_two_numbers_are_the_axes(self):
        self.open()
        self.go_to("any-two")
        card = "sixdofReport.cards.metrics"
        self.browser.run(f"Object.assign({card}.choices, {{query: 'distance', axis_x: 'processor_mean_ns', axis_y: 'error_rms'}}) && {card}.draw()")
        shown = f"{card}.shown().rows.filter(row => row.algorithm === 'exact').map(row => [row.x === row.processor_mean_ns, row.y === row.error_rms])"
        self.assertEqual(self.browser.run(shown), [[True, True]])

    def test_frontier_is_that_of_the_data(self):
        self.open()
        self.go_to("tradeoff")
        card = "sixdofReport.cards.frontier"
        for cost in self.browser.run(f"sixdofReport.valuesOf({card}.all, 'cost')"):
            self.browser.run(f"{card}.choices.cost = {json.dumps(cost)}, {card}.draw()")
            self.assertEqual(self.browser.run(f"[...new Set({card}.shown().rows.map(row => row.cost))]"), [cost])
            self.assertIn("yes", self.browser.run(f"{card}.shown().rows.map(row => row.frontier)"))

    def test_theme_button_redraws(self):
        self.open()
        self.go_to("speed")
        colour = "document.querySelector('#figure-time_distance .plot svg .role-axis-label text')?.getAttribute('fill')"
        light = self.browser.run(colour)
        self.browser.run("document.getElementById('theme').click()")
        self.browser.wait_for(f"{colour} !== {json.dumps(light)}")
        self.assertEqual(self.browser.run("document.documentElement.dataset.theme"), "dark")

    def test_click_tells_the_command(self):
        self.open()
        self.go_to("stability")
        self.browser.run("sixdofReport.cards.stability.tell(sixdofReport.cards.stability.shown().rows[2])")
        told = self.browser.run("document.querySelector('#figure-stability .detail').textContent")
        self.assertIn("sixdof query --a a.off --b b.off", told)
        self.assertIn(HOSTILE, told)

    def test_click_on_a_mark_reaches_the_detail(self):
        self.open()
        self.go_to("stability")
        place = self.browser.run("""(() => { const box = document.querySelector('#figure-stability .plot svg .mark-rect path').getBoundingClientRect();
            return [box.x + box.width / 2, box.y + box.height / 2]; })()""")
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left", clickCount=1)
        self.browser.wait_for("document.querySelector('#figure-stability .detail code') !== null")

    def see(self, figure, wanted):
        """Clicks "show in 3D" for the first row of a figure with these values, and waits for the picture."""
        if not self.browser.run("!!document.createElement('canvas').getContext('webgl2')"):
            self.skipTest("this browser has no WebGL")
        self.browser.run(f"""(() => {{ const card = sixdofReport.cards[{json.dumps(figure)}], wanted = {json.dumps(wanted)};
            card.tell(card.all.find(row => Object.keys(wanted).every(key => row[key] === wanted[key]))); }})()""")
        self.browser.run(f"document.querySelector('#figure-{figure} .to-scene').click()")
        self.wait_for_view()
        return self.browser.run("document.querySelector('#figure-view select').selectedOptions[0].textContent")

    def wait_for_view(self):
        self.browser.wait_for("sixdofReport.ready === 'view' && Number(document.querySelector('#figure-view')?.dataset.drawn) > 100")

    def pose_in_view(self):
        """Translation of B as drawn, and as the command below the picture types it."""
        drawn = self.browser.run("sixdofReport.view.b.position.toArray()")
        command = self.browser.run("document.querySelector('#figure-view .command code').textContent")
        return drawn, [float(number) for number in command.split('--pose "')[1].split()[:3]], command

    def test_outlier_of_every_figure_opens_its_pose(self):
        if not self.browser.run("!!document.createElement('canvas').getContext('webgl2')"):
            self.skipTest("this browser has no WebGL")
        self.open()
        linked, posed = [], []
        for page in self.pages():
            self.go_to(page)
            for figure in self.figures():
                if not self.browser.run(f"!!document.querySelector('#{figure} .finding a')"):
                    continue
                linked.append(figure[7:])
                self.browser.run(f"document.querySelector('#{figure} .finding a').click()")
                self.wait_for_view()
                if self.browser.run("sixdofReport.view.scene.kind") == "pose":
                    drawn, typed, command = self.pose_in_view()
                    for one, other in zip(drawn, typed):
                        self.assertAlmostEqual(one, other, delta=1e-5)
                    self.assertRegex(command, r"^sixdof query --a torus-1k .*--pose \"\d+\.1234567890\d+ \d 0 1 0 0 0\"$")
                    posed.append(figure[7:])
                self.go_to(page)
        for figure in ("winners", "time_distance", "time_volume", "response_errors", "update_rates", "frontier", "metrics"):
            self.assertIn(figure, posed)
        for figure in ("scenario_measures", "equal_time", "signals", "perception"):
            self.assertIn(figure, linked)
        self.assertEqual(self.browser.errors, [])

    def test_click_on_a_point_leads_to_its_pose(self):
        self.open()
        self.go_to("speed")
        self.browser.run("sixdofReport.cards.time_distance.choices.pair = 'elephant', sixdofReport.cards.time_distance.draw()")
        self.browser.run("document.querySelector('#figure-time_distance').scrollIntoView()")
        place = self.browser.run("""(() => { const points = document.querySelectorAll('#figure-time_distance .plot svg .mark-symbol path');
            const box = points[points.length - 1].getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()""")
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=place[0], y=place[1], button="left", clickCount=1)
        self.browser.wait_for("document.querySelector('#figure-time_distance .detail .to-scene') !== null")
        self.assertEqual(self.browser.run("document.querySelectorAll('#figure-time_distance .detail .command').length"), 2)
        command = self.browser.run("document.querySelectorAll('#figure-time_distance .detail .command code')[1].textContent")
        self.browser.run("document.querySelector('#figure-time_distance .to-scene').click()")
        self.browser.wait_for("sixdofReport.ready === 'view'")
        self.assertEqual(self.browser.run("document.querySelector('#figure-view .command code').textContent"), command)
        self.assertIn("From a figure", self.browser.run("[...document.querySelectorAll('#figure-view optgroup:not([hidden])')].map(g => g.label)"))

    def test_moment_of_a_signal_opens_in_3d(self):
        self.open()
        self.go_to("signals")
        time_ms = self.browser.run("sixdofReport.cards.signals.all.find(row => row.time_ms > 60).time_ms")
        self.assertEqual(self.see("signals", {"time_ms": time_ms}), "II: vps")
        moment = self.browser.run("Number(document.querySelector('#figure-view input[type=range]').value)")
        self.assertEqual(moment, round(time_ms))
        self.browser.run("document.querySelector('#figure-view .controls button').click()")
        self.browser.wait_for(f"Number(document.querySelector('#figure-view input[type=range]').value) > {moment}")
        self.assertEqual(self.browser.errors, [])

    def test_fault_of_a_hard_case_opens_its_pose(self):
        self.open()
        self.go_to("stability")
        self.assertEqual(self.see("stability", {"family": "kissing", "algorithm": "ode"}), "kissing: ode")
        self.assertIn("--pose", self.browser.run("document.querySelector('#figure-view .command').textContent"))
        self.assertEqual(self.browser.run("sixdofReport.view.b.position.x"), 0.5)

    def test_phone_has_no_sideways_scroll(self):
        self.open(width=390)
        for page in self.pages():
            self.go_to(page)
            self.assertLessEqual(self.browser.run("document.documentElement.scrollWidth"), 390, page)
            self.shot(f"{page}-phone")
        self.assertEqual(self.browser.errors, [])

    def test_pages_without_data_are_folded_and_tabs_take_two_rows(self):
        self.open(width=1400)
        self.assertLessEqual(self.browser.run("document.querySelector('nav').getBoundingClientRect().height"), 90)
        self.open(width=1400, page=self.plain)
        empty = self.browser.run("[...document.querySelectorAll('nav details a')].map(a => a.hash.slice(1))")
        self.assertEqual(sorted(empty), ["casts", "collection", "compare", "contacts", "deforming", "depths", "history", "scenes", "signals", "stability"])
        self.assertIn("without data: 10", self.browser.run("document.querySelector('nav summary').textContent"))
        self.assertEqual(self.browser.run("document.querySelectorAll('nav > a').length + document.querySelectorAll('nav details a').length"), len(self.pages()))

    def test_figures_have_no_scrollbars_on_a_desk(self):
        self.open(width=1400)
        for page in self.pages():
            self.go_to(page)
            scrolled = self.browser.run("[...document.querySelectorAll('.plots')].filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.parentElement.id)")
            self.assertEqual(scrolled, [], page)

    def test_algorithms_have_their_colours_everywhere(self):
        self.open()
        self.go_to("speed")
        chip = self.browser.run("""[...document.querySelectorAll('#figure-time_distance .chip')].filter(c => c.textContent === 'vps')
            .map(c => c.querySelector('.swatch')).map(s => [s.className, s.style.getPropertyValue('--colour')])[0]""")
        self.assertEqual(chip, ["swatch square", "#d55e00"])
        drawn = "[...document.querySelectorAll('#figure-time_distance .mark-line path')].map(p => p.getAttribute('stroke'))"
        self.assertIn("#d55e00", self.browser.run(drawn))
        self.go_to("view")
        entry = "[...document.querySelectorAll('#figure-view .chip')].filter(c => c.textContent.startsWith('vps')).map(c => c.querySelector('.swatch').style.getPropertyValue('--colour'))"
        self.assertEqual(self.browser.run(entry), ["#d55e00"])

    def test_keyboard_reaches_pages_and_controls(self):
        self.open()
        self.browser.call("Input.dispatchKeyEvent", type="keyDown", key="Tab", code="Tab", windowsVirtualKeyCode=9)
        self.assertEqual(self.browser.run("document.activeElement.className"), "skip")
        focusable = self.browser.run("[...document.querySelectorAll('nav a, .figure input, .figure button, .figure select')].every(e => e.tabIndex >= 0)")
        self.assertTrue(focusable)
        self.assertEqual(self.browser.run("[...document.querySelectorAll('.plot svg')].filter(s => !s.getAttribute('aria-label')).length"), 0)

    def test_file_asks_no_network_and_is_small(self):
        self.assertLess(self.page.stat().st_size, 10 << 20)
        self.open()
        asked = self.browser.run("performance.getEntriesByType('resource').map(entry => entry.name)")
        self.assertEqual(asked, [])

    def test_planted_regression_stands_in_the_page(self):
        self.open()
        self.go_to("compare")
        self.assertIn("64 slower, 0 faster", self.browser.run("document.querySelector('.sentences').textContent"))


if __name__ == "__main__":
    if CHROMIUM is None:
        print("skipped: no Chromium here (cmake/setup report installs it)")
        sys.exit(SKIPPED)
    unittest.main()
