"""Sheets of pictures: where each lands, and what a map's colours say."""

from __future__ import annotations

import numpy as np

import lobula
from lobula.report.canvas import rgb
from lobula.report.montage import Tile, map_picture, montage
from lobula.report.palette import DARK
from lobula.report.plots import Scene
from lobula.report.sheet import scene_sheet
from lobula.report.strip import STRIP_HEIGHT


def test_tiles_lie_row_by_row_with_every_pixel_repeated():
    tiles = [Tile(np.full((10, 20), 10 * i, np.uint8), "x") for i in range(3)]
    sheet = montage(tiles, columns=2, tile_width=40)
    places = {0: (12, 12), 1: (12, 64), 2: (58, 12)}  # gap 12; tiles 20 x 40 px, captions 26 px below each
    for i, (top, left) in places.items():
        assert (sheet[top : top + 20, left : left + 40] == 10 * i).all()
    assert sheet.shape == (2 * 46 + 12, 2 * 52 + 12, 3)


def test_a_map_is_grey_at_zero_orange_above_blue_below():
    picture = map_picture(np.array([[0.0, 2.0, -2.0, 1.0]], np.float32))
    assert tuple(picture[0, 0]) == rgb(DARK.panel)
    assert picture[0, 1, 0] > picture[0, 1, 2]  # red over blue
    assert picture[0, 2, 2] > picture[0, 2, 0]
    assert picture[0, 3, 0] < picture[0, 1, 0]  # half the magnitude, less colour


def test_an_empty_map_is_all_ground():
    assert (map_picture(np.zeros((3, 4), np.float32)) == rgb(DARK.panel)).all()


def test_a_sheet_of_scenes():
    movie = lobula.stimuli.looming(scene="arena", speed_cm_s=12)
    trace = lobula.Network().run(movie.images, movie.times_s)
    scene = Scene("approach", list(movie.frames()), trace)
    one, two = scene_sheet([scene]), scene_sheet([scene, scene])
    assert len(two) == 2 * len(one)
    red = np.array(rgb(DARK.collision))
    assert (one[-STRIP_HEIGHT:] == red).all(axis=-1).any()  # the decision is shown
