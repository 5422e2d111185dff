"""The page in a real browser: it loads, moves, alarms, obeys, comes back, fits, and has nothing to complain of.

With ``LOBULA_SCREENSHOTS`` set to a folder, pictures of it are left there.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lobula
from lobula.dashboard import board as board_module
from lobula.dashboard.about import about_run, board_of_trace
from lobula.dashboard.analysis import Analysis
from lobula.dashboard.board import Board
from lobula.dashboard.live_settings import LiveSettings
from lobula.dashboard.recorded_scenes import RecordedScenes
from lobula.dashboard.replay import Replay
from lobula.dashboard.rows import Rows
from lobula.dashboard.server import Site
from lobula.runtime.header import run_header

from .chromium import Chromium, Page, find_chromium
from .clips import approach, recording
from .stage import live, toml
from .test_saved_trace import trace as long_trace

PROGRAM = find_chromium()
pytestmark = pytest.mark.skipif(
    PROGRAM is None, reason="no chromium on this machine: the page is not seen in a browser"
)

STATE = "document.querySelector('#state').textContent"
VALUE = "document.querySelector('.trace.lgmd1 .value').textContent"
TRACE = "document.querySelector('.trace.lgmd1 canvas').toDataURL()"
PICTURE = "document.querySelector('#picture').toDataURL()"
COLOURED = (
    "(() => { const m = document.querySelector('#map'), c = document.createElement('canvas'); if (m.hidden) return; "
    "const p = c.getContext('2d', { willReadFrequently: true }); p.drawImage(m, 0, 0); "
    "return p.getImageData(0, 0, 99, 72).data.some((v, i) => i % 4 === 3 && v > 40) })()"
)
CLOCK = "document.querySelector('#clock').textContent"
FIGURES = "document.querySelector('#figures').textContent"
LISTED = "document.querySelectorAll('#list li.collision').length"
NOT_LISTED = "document.querySelector('#list .none')?.textContent"

SIZES = [("wide", 1440, 900), ("middle", 1000, 760), ("narrow", 390, 844), ("tiny", 320, 568)]


@pytest.fixture(scope="module")
def browser():
    assert PROGRAM is not None
    with Chromium(PROGRAM) as browser:
        yield browser


@contextmanager
def seen(browser: Chromium, url: str, *, expected: str = "", **look: Any) -> Iterator[Page]:
    """A tab that shows ``url``. Its console must stay silent, but for lines with ``expected``."""
    page = browser.page(**look)
    page.open(url)
    yield page
    assert [line for line in page.complaints() if not expected or expected not in line] == []
    page.close()


@pytest.fixture(scope="module")
def images():
    """Something comes, something passes, over and over; 2 x as large as the working image."""
    views = {"scene": "arena", "width": 198, "height": 144}
    return np.concatenate(
        [lobula.stimuli.looming(speed_cm_s=12.0, **views).images[15:], lobula.stimuli.translating(**views).images]
    )


@pytest.fixture(scope="module")
def clip(tmp_path_factory):
    return approach(tmp_path_factory.mktemp("clips") / "approach.mp4", width=198, height=144)


@contextmanager
def replayed(clip) -> Iterator[tuple[Site, LiveSettings]]:
    """The page of a recording; its analysis runs in a thread that ends with the process."""
    found, settings = recording(clip), LiveSettings(lobula.preset(), "default")
    analysis = Analysis(found)
    header = run_header(found.source, settings.params, preset="default", engine="core")
    about, scenes = about_run("recording", header, settings), RecordedScenes(analysis)
    board = Board(about, Rows(), settings=settings, scenes=scenes)
    replay = Replay(analysis, settings, board, lambda before, after: None, lambda text: None)
    threading.Thread(target=replay.work, daemon=True).start()
    with Site(board, toml) as site:
        yield site, settings


def shown(page: Page, name: str) -> None:
    """Leave a picture for whoever wants to look at it."""
    folder = os.environ.get("LOBULA_SCREENSHOTS")
    if folder:
        page.screenshot(Path(folder, f"{name}.png"))


class TestLive:
    def test_it_loads_moves_and_raises_the_alarm(self, browser, images):
        with live(images) as stage, seen(browser, stage.site.url) as page:
            page.until(f"{STATE} === 'ok'")
            page.until("!document.querySelector('#picture').hidden && document.querySelector('#nothing').hidden")
            page.until(f"(window.trace ??= {TRACE}) !== {TRACE}")
            page.until(f"(window.picture ??= {PICTURE}) !== {PICTURE}")
            page.until(f"{STATE} === 'COLLISION'")
            page.until("document.querySelector('#stage.collision') && document.title.startsWith('COLLISION')")
            shown(page, "live-alarm")
            page.until("document.querySelector('#list li.collision b').textContent.startsWith('Collision')")
            page.until(f"{STATE} === 'ok'")
            page.until("document.querySelector('#figures').textContent.includes('latency, median')")
            assert page.js("document.querySelector('#name').textContent") == "movie camera"

    def test_maps_on_demand(self, browser, images):
        choose = "(name) => { const s = document.querySelector('#layer'); s.value = name; s.onchange() }"
        with live(images) as stage, seen(browser, stage.site.url) as page:
            page.until("document.querySelectorAll('#layer option').length === 14")
            for name in ("lamina", "lgmd1_summation", "motion"):
                page.js(f"({choose})({name!r})")
                page.until("document.querySelector('#scale').textContent.startsWith('full colour')")
                page.until(COLOURED)
            page.js(f"({choose})('')")
            page.until("document.querySelector('#map').hidden")

    def test_a_slider_changes_the_detector_and_the_page_of_the_others(self, browser, images):
        with live(images) as stage, seen(browser, stage.site.url) as page, seen(browser, stage.site.url) as other:
            for each in (page, other):
                each.until("document.querySelector('[id=\"set-decision.collision_spikes\"]')?.value === '4'")
            page.js(
                "(() => { const s = document.querySelector('[aria-label=\"Spikes for an alarm\"]'); "
                "s.value = 1000; s.oninput() })()"
            )
            other.until("document.querySelector('[id=\"set-decision.collision_spikes\"]').value === '20'")
            assert stage.settings.params.decision.collision_spikes == 20
            assert page.js("document.querySelectorAll('.setting.changed').length") == 1
            page.click("#restore")
            other.until("document.querySelector('[id=\"set-decision.collision_spikes\"]').value === '4'")
            page.until("!document.querySelector('.setting.changed')")

    def test_a_threshold_is_dragged_in_its_trace(self, browser, images):
        with live(images) as stage, seen(browser, stage.site.url) as page:
            page.until(f"{STATE} === 'ok'")
            x, top, height = page.js(
                "(() => { const b = document.querySelector('.trace.lgmd1 canvas').getBoundingClientRect(); "
                "return [b.left + b.width / 2, b.top, b.height] })()"
            )
            low, high = 0.5, 1.0
            at = lambda level: top + 3 + (high - level) / (high - low) * (height * 0.8 - 6)  # noqa: E731
            page.mouse("mousePressed", x, at(0.7), 1)
            page.mouse("mouseMoved", x, at(0.8), 1)
            page.mouse("mouseMoved", x, at(0.9), 1)
            page.mouse("mouseReleased", x, at(0.9))
            page.until("Math.abs(document.querySelector('[id=\"set-lgmd1.spiking.threshold\"]').value - 0.9) < 0.02")
            assert stage.settings.params.lgmd1.spiking.threshold == pytest.approx(0.9, abs=0.02)

    def test_a_value_that_is_not_allowed_is_told_and_taken_back(self, browser, images):
        # the browser logs an answer of that kind by itself
        with live(images) as stage, seen(browser, stage.site.url, expected="422") as page:
            field = "document.querySelector('[id=\"set-decision.collision_spikes\"]')"
            page.until(f"{field}?.value === '4'")
            page.js(f"{field}.value = 4000; {field}.onchange()")
            page.until("document.querySelector('#refused').textContent.includes('must be int in [1, 100]')")
            page.until(f"{field}.value === '4'")

    def test_it_comes_back_when_the_program_does(self, browser, images):
        with ExitStack() as second:
            with live(images) as stage:
                page = second.enter_context(seen(browser, stage.site.url, expected="ERR_CONNECTION"))
                page.until(f"{STATE} === 'ok'")
                port = stage.site.port
            page.until("document.querySelector('#notice').textContent.includes('Trying again')")
            assert page.js("document.body.classList.contains('lost')")
            assert page.js(STATE) == "ended"  # and not ok any more
            page.look(1000, 700)  # drawn anew
            assert page.js(STATE) == "ended"
            with live(images, port=port):
                page.until("!document.body.classList.contains('lost') && document.querySelector('#notice').hidden")
                page.until(f"(window.before ??= {TRACE}) !== {TRACE}")  # whatever is loaded anew meanwhile

    def test_collisions_that_are_no_longer_listed_are_counted(self, browser, images):
        header = {"source": "camera"}
        board = Board(about_run("live", header, LiveSettings(lobula.preset(), "default")), Rows(keep=64))
        board.rows.append(0, lobula.Network().step(images[0], 0.0))
        for number in range(1, 201):
            for phase in ("start", "end"):
                board.add_event({"type": "collision", "phase": phase, "id": number, "frame": 0, "time_s": 2.0 * number})
        with Site(board, toml) as site, seen(browser, site.url) as page:
            page.until(f"{FIGURES}.includes('200collisions')")
            assert page.js(LISTED) == 150
            assert page.js("document.querySelector('#list li b').textContent") == "Collision 200"
            assert page.js("document.querySelector('#list li:last-child').textContent") == (
                "50 earlier collisions not listed"
            )
            shown(page, "many-collisions")

    def test_the_token_is_asked_for_and_leaves_the_address(self, browser, images):
        with live(images, token="correct horse battery") as stage:
            with seen(browser, stage.site.url, expected="401") as page:
                page.until("document.querySelector('.login form')")
                shown(page, "login")
                page.js("document.querySelector('#token').value = 'correct horse battery'; document.forms[0].submit()")
                page.until(f"document.querySelector('#state') && {STATE} === 'ok'")
            with seen(browser, stage.site.link.replace(" ", "%20")) as page:
                page.until(f"document.querySelector('#state') && {STATE} === 'ok'")
                assert page.js("location.href") == stage.site.url


class TestARecording:
    def test_it_plays_and_is_scrubbed(self, browser, clip):
        with replayed(clip) as (site, _), seen(browser, site.url) as page:
            page.until(f"parseFloat({CLOCK}) > 0.2")  # it plays by itself
            page.until("document.querySelector('#figures').textContent.includes('91')")
            page.until(f"{STATE} === 'COLLISION'")
            page.js("(() => { const s = document.querySelector('#seek'); s.value = 30; s.oninput() })()")
            page.until(f"{CLOCK} === '1.00 / 3.00 s' && {STATE} === 'ok'")
            picture = page.js(PICTURE)
            page.click("#forth")
            page.until(f"{CLOCK}.startsWith('1.03')")
            page.js("document.activeElement.blur()")
            page.press("ArrowLeft")
            page.press("ArrowLeft")
            page.until(f"{CLOCK}.startsWith('0.97')")
            page.until(f"{PICTURE} !== {picture!r}")
            page.click("#list li.collision")
            page.until(f"{STATE} === 'COLLISION'")
            page.until("document.querySelector('#verdict').className === 'collision'")
            shown(page, "recording")
            page.press(" ")
            page.until(f"{CLOCK} === '3.00 / 3.00 s'")  # to the end

    def test_other_settings_change_all_of_it_at_once(self, browser, clip):
        with replayed(clip) as (site, settings), seen(browser, site.url) as page:
            page.until("document.querySelector('#list li.collision')")
            strip = page.js("document.querySelector('#timeline canvas').toDataURL()")
            settings.change({"decision.collision_spikes": 90})
            page.until("!document.querySelector('#list li.collision')")
            page.until(f"document.querySelector('#timeline canvas').toDataURL() !== {strip!r}")
            page.until("document.querySelector('#figures').textContent.includes('0collisions')")

    def test_a_long_one_counts_and_lists_every_collision(self, browser, monkeypatch):
        with Site(board_of_trace(long_trace(500), {}, "a.npz"), toml) as site, seen(browser, site.url) as page:
            page.until(f"{FIGURES}.includes('500collisions')")
            assert page.js(LISTED) == 500
            assert page.js(NOT_LISTED) is None
        monkeypatch.setattr(board_module, "MOST_RECORDED", 400)
        with Site(board_of_trace(long_trace(500), {}, "b.npz"), toml) as site, seen(browser, site.url) as page:
            page.until(f"{FIGURES}.includes('500collisions')")
            assert page.js(LISTED) == 200
            assert page.js(NOT_LISTED) == "300 earlier collisions not listed"

    def test_a_saved_trace_has_curves_and_no_pictures(self, browser):
        movie = lobula.stimuli.looming(scene="arena", speed_cm_s=12.0)
        trace = lobula.Network().run(movie.images, movie.times_s)
        with Site(board_of_trace(trace, {}, "run.npz"), toml) as site, seen(browser, site.url) as page:
            page.until("document.querySelector('#list li.collision')")
            assert "holds no pictures" in page.js("document.querySelector('#nothing').textContent")
            assert page.js("document.querySelector('#settings').hidden && document.querySelector('#layers').hidden")
            page.click("#list li.collision")
            page.until(f"{STATE} === 'COLLISION'")
            shown(page, "trace")


class TestLooks:
    def test_it_fits_every_screen_and_follows_the_theme(self, browser, clip):
        with replayed(clip) as (site, settings), seen(browser, site.url) as page:
            settings.change({"decision.window_ms": 250.0})
            page.until("document.querySelector('.setting.changed') && document.querySelector('#list li.collision')")
            page.click("#list li.collision")
            page.until("document.querySelector('#verdict').className === 'collision'")
            for name, width, height in SIZES:
                for dark in (False, True):
                    page.look(width, height, dark=dark, mobile=width < 500)
                    time.sleep(0.3)  # it is drawn anew
                    shown(page, f"{name}-{'dark' if dark else 'light'}")
                    assert page.js("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
                    colour = page.js("getComputedStyle(document.body).backgroundColor.match(/\\d+/g).join(' ')")
                    assert (sum(map(int, colour.split())) < 120) == dark

    def test_the_switch_of_the_theme_is_remembered(self, browser, clip):
        with replayed(clip) as (site, _), seen(browser, site.url) as page:
            page.click("#theme")
            page.open(site.url)
            assert page.js("getComputedStyle(document.documentElement).colorScheme") == "dark"

    def test_every_control_has_a_name(self, browser, clip):
        """For those who do not see it."""
        with replayed(clip) as (site, _), seen(browser, site.url) as page:
            page.until("document.querySelectorAll('.setting').length > 10")
            assert page.js(
                "[...document.querySelectorAll('button, select, input')]"
                ".every((e) => e.labels?.length || e.ariaLabel || e.textContent.trim())"
            )
