"""Pictures with a known answer, made once and read by every process: the network takes them as they lie on the disk."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..engine.network import Network
from ..errors import ParameterError
from ..evaluate.labels import Label
from ..evaluate.scoring import ClipScore, last_frame, score_clip
from ..landing import writing
from ..model.network import NetworkParams
from ..types import TRACE_DTYPE, Frame


@dataclass(frozen=True, eq=False)
class Film:
    """A movie or clip at the working size, and what happens in it.

    Attributes
    ----------
    path : the pictures, one after the other, without a heading
    shape, dtype : (T, H, W) and kind of number of the pictures
    times_s, frames : (T,) stamp and number of each picture
    digest : changes when picture, stamp or label does
    """

    label: Label
    path: Path
    shape: tuple[int, int, int]
    dtype: str
    times_s: NDArray[np.float64] = field(repr=False)
    frames: NDArray[np.int64] = field(repr=False)
    digest: str

    @property
    def name(self) -> str:
        """The movie or file."""
        return self.label.file

    @property
    def images(self) -> NDArray[Any]:
        """The pictures, (T, H, W), read from the disk as they are needed."""
        return np.memmap(self.path, self.dtype, "r", shape=self.shape)

    @property
    def quiet(self) -> ClipScore:
        """The score of a network that never alarms."""
        trace = np.zeros(len(self.times_s), TRACE_DTYPE)
        trace["time_s"], trace["frame"] = self.times_s, self.frames
        return score_clip(self.label, trace)

    @property
    def length_s(self) -> float:
        """From the first picture to the last, s."""
        return float(self.times_s[-1] - self.times_s[0])


def save_film(path: Path, label: Label, pictures: Iterable[Frame]) -> Film:
    """Write the pictures up to the last one that counts to ``path`` and return the film.

    Raises
    ------
    OutputError : they cannot be written
    ParameterError : there is none
    """
    last, digest = last_frame(label), hashlib.sha256(repr(label).encode())
    times_s, frames, like = [], [], None
    with writing(path), path.open("wb") as file:
        for picture in pictures:
            if last is not None and picture.index > last:
                break
            like = np.ascontiguousarray(picture.image)
            file.write(like.data)
            digest.update(like.data)
            times_s.append(picture.time_s)
            frames.append(picture.index)
    if like is None:
        raise ParameterError(f"{label.file}: no frame that counts: must have at least one")
    digest.update(np.array([times_s, frames], np.float64).data)
    return Film(
        label=label,
        path=path,
        shape=(len(frames), like.shape[0], like.shape[1]),
        dtype=like.dtype.str,
        times_s=np.array(times_s, np.float64),
        frames=np.array(frames, np.int64),
        digest=digest.hexdigest(),
    )


def score_films(params: NetworkParams, films: Iterable[Film]) -> list[ClipScore]:
    """Run a fresh network over each film and score it, as ``lobula evaluate`` does with clips."""
    network, scores = Network(params), []
    for film in films:
        network.reset()
        trace = network.run(film.images, film.times_s)
        trace["frame"] = film.frames
        scores.append(score_clip(film.label, trace))
    return scores


def digest_of(films: Sequence[Film]) -> str:
    """Return twelve hexadecimal digits that change when any of ``films`` does, or their order."""
    return hashlib.sha256("".join(film.digest for film in films).encode()).hexdigest()[:12]
