"""The plots: the curves are the trace, and the files open."""

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from lobula.errors import MissingExtraError, OutputError, ParameterError
from lobula.report.plots import Scene, plot_demo, plot_scenes, plot_trace, save_figure
from lobula.types import NEURONS, TRACE_DTYPE, Frame

from .approach import FRAMES, HEADER, table

FRAME_LIST = [Frame(np.full((24, 32), 8 * i, np.uint8), i / 10, i) for i in range(FRAMES)]


def test_curves_are_the_trace_and_thresholds_are_drawn() -> None:
    figure = plot_trace(table(), HEADER)
    lgmds, lptcs, *_ = figure.axes
    curves = {line.get_label(): line for axes in (lgmds, lptcs) for line in axes.lines}
    for neuron, label in zip(NEURONS, ("LGMD-1", "LGMD-2", "LPTC-R", "LPTC-L"), strict=True):
        assert np.array_equal(curves[label].get_xdata(), table()["time_s"])
        assert np.array_equal(curves[label].get_ydata(), table()[neuron])
    levels = [[float(line.get_ydata()[0]) for line in axes.lines[2:]] for axes in (lgmds, lptcs)]
    assert levels == [[0.7], [-0.2, 0.2]]


def test_collision_is_shaded_from_its_first_frame_to_the_one_after() -> None:
    shade = plot_trace(table()).axes[0].collections[0].get_paths()[0].get_extents()
    assert (shade.x0, shade.x1) == pytest.approx((1.8, 2.4))


def test_title_names_the_run_and_survives_dollars() -> None:
    figure = plot_trace(table(), {**HEADER, "source": "/data/a$b$c.mp4"})
    figure.canvas.draw()
    assert figure.get_suptitle().startswith(r"a\$b\$c.mp4")
    assert "0123456789ab" in figure.get_suptitle()


@pytest.mark.parametrize(("suffix", "start"), [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".pdf", b"%PDF")])
def test_figure_is_saved(tmp_path: Path, suffix: str, start: bytes) -> None:
    path = save_figure(plot_trace(table(), HEADER), tmp_path / f"p{suffix}")
    assert path.read_bytes().startswith(start)
    if suffix == ".svg":
        ElementTree.parse(path)
        again = save_figure(plot_trace(table(), HEADER), tmp_path / "again.svg")
        assert again.read_bytes() == path.read_bytes()


def test_demo_shows_the_frame_of_the_decision() -> None:
    figure = plot_demo(FRAME_LIST, table(), "a looming disc")
    pictures = figure.axes[-1]
    assert pictures.get_title() == "a looming disc"
    assert len(pictures.images) == 6
    assert "1.80 s: collision" in [text.get_text() for text in pictures.texts]
    assert 18 * 8 in [int(image.get_array()[0, 0]) for image in pictures.images]


def test_scenes_stand_side_by_side() -> None:
    quiet = table()
    quiet["collision"] = False
    figure = plot_scenes([Scene("looming", FRAME_LIST, table()), Scene("passing", FRAME_LIST, quiet)], HEADER)
    assert len(figure.axes) == 10
    assert not [t for t in figure.axes[-1].texts if "collision" in t.get_text()]
    figure.canvas.draw()


def test_one_frame_is_enough_and_none_is_said() -> None:
    plot_trace(table()[:1]).canvas.draw()
    with pytest.raises(ParameterError, match="the trace has no rows"):
        plot_trace(np.zeros(0, TRACE_DTYPE))


def test_other_suffixes_and_missing_folders(tmp_path: Path) -> None:
    figure = plot_trace(table())
    with pytest.raises(ParameterError, match=r"p\.jpg: must end in \.png, \.svg, \.pdf"):
        save_figure(figure, tmp_path / "p.jpg")
    with pytest.raises(OutputError, match="no such folder"):
        save_figure(figure, tmp_path / "none" / "p.png")


def test_without_matplotlib_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(MissingExtraError, match=r'plots need matplotlib: pip install "lobula\[plot\]"'):
        plot_trace(table())


def test_import_is_light_and_no_window_is_opened() -> None:
    code = (
        "import sys; import lobula.report.plots as p; assert 'matplotlib' not in sys.modules;"
        "p.new_figure(4, 3); assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
