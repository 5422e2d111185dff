from dataclasses import replace
from pathlib import Path

import pytest
import roofline

from lobula.engine import library
from lobula.model.presets import preset


def test_the_core_keeps_the_counted_planes_and_little_more():
    if not library.available():
        pytest.skip(f"no C core: {library.why_not()}")
    from lobula.engine.structures import core_params

    # at a width that is a multiple of every vector nothing is padded
    size = library.library().lobula_state_size(core_params(preset("published")), 640, 480, 0)
    assert roofline.state_bytes(640, 480) == 6 * 4 * 640 * 480
    assert 1.0 <= size / roofline.state_bytes(640, 480) < 1.01


def test_bytes_of_a_step_by_hand():
    assert roofline.bytes_per_pixel() == 6 * 4 + 6 * 4 + 1
    assert roofline.bytes_per_pixel(frames=8) == 48 / 8 + 1


def test_gaussian_passes_by_hand():
    # 5 and 9 taps, symmetric: 4 sums of pairs serve both rows of weights, 3 and 5 products; then 2 + 3 and 4 + 5
    work = {w.part: w.operations for w in roofline.operations(preset("published"))}
    assert work["Gaussians, along rows"] == 4 + 3 + 5
    assert work["Gaussians, along columns"] == 5 + 9


def test_branches_that_are_alike_count_once():
    published = preset("published")  # LGMD-2 differs from LGMD-1 in its ON branch
    alike = replace(published, lgmd2=replace(published.lgmd2, on=published.lgmd1.on))
    counts = [next(w.operations for w in roofline.operations(p) if w.part == "inhibition") for p in (published, alike)]
    assert counts == [30, 20]


def test_the_limit_is_the_larger_of_both_times():
    total = sum(w.operations for w in roofline.operations(preset("published")))
    pixels = 99 * 72
    peaks = roofline.Peaks("x86-64-v3", 32, {"fma": 1e9, "add": 2e9}, {roofline.state_bytes(99, 72): 1e9})
    limit = roofline.limit(peaks, 99, 72)
    assert limit.operations_us == pytest.approx(total * pixels / 8 / 2e3)
    assert limit.bytes_us == pytest.approx(49 * pixels / 1e3)
    assert limit.us == limit.bytes_us
    assert limit.by == "memory"


def test_better_takes_the_best_of_both():
    a = roofline.Peaks("x86-64", 16, {"fma": 1.0, "add": 4.0}, {8: 3.0})
    b = roofline.Peaks("x86-64", 16, {"fma": 2.0, "add": 3.0}, {8: 1.0})
    assert roofline.better(a, b) == roofline.Peaks("x86-64", 16, {"fma": 2.0, "add": 4.0}, {8: 3.0})


def test_the_page_tells_the_same_counts():
    page = Path(__file__).parents[2].joinpath("docs/performance.md").read_text(encoding="utf-8")
    work = roofline.operations(preset("published"))
    for w in work:
        assert f"| {w.part} | {w.operations} | {w.count} |" in page
    assert f"| all | {sum(w.operations for w in work)} |" in page
    assert f"**{roofline.bytes_per_pixel():g} bytes a pixel**" in page
