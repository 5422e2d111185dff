import numpy as np

from lobula.bench.scenes import Loop, pure_noise, scenes, to_and_fro


def test_movies_have_the_asked_size_and_change_all_over():
    movies = scenes(99, 72, 20)
    for images in movies.values():
        assert images.shape == (20, 72, 99)
        assert images.dtype == np.uint8
        changed = np.diff(images.astype(int), axis=0) != 0
        assert changed.mean(axis=(1, 2)).min() > 0.5
    assert pure_noise(40, 30, 5).shape == (5, 30, 40)


def test_there_and_back_without_showing_an_end_twice():
    images = np.arange(4, dtype=np.uint8)[:, None, None]
    assert to_and_fro(images).ravel().tolist() == [0, 1, 2, 3, 2, 1]


def test_loop_goes_on_and_its_clock_never_runs_back():
    loop = Loop(np.arange(3, dtype=np.uint8)[:, None, None])
    seen = [*loop.take(2), *loop.take(3)]
    assert [int(image[0, 0]) for image, _ in seen] == [0, 1, 2, 0, 1]
    assert [time_s for _, time_s in seen] == [i / 30 for i in range(5)]
    assert loop.times_s() == [5 / 30, 6 / 30, 7 / 30]
