"""How fast the camera itself turned: a gyroscope's record in a file, read at the times of the frames."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import ParameterError

COLUMNS = ("time_s", "yaw_deg_s")

REACH_S = 0.5
"""A frame may lie this far outside the record, s: gyroscope and camera are seldom started and stopped together."""


@dataclass(frozen=True, eq=False)
class YawRecord:
    """Yaw rates of a camera, deg/s, at increasing times: seconds from the first picture, as the frames' own stamps."""

    name: str
    times_s: NDArray[np.float64]
    rates_deg_s: NDArray[np.float64]

    def at(self, time_s: float) -> float:
        """Return the rate at ``time_s``: linear between two rows, the nearest row's up to ``REACH_S`` outside.

        Raises
        ------
        ParameterError : a time further outside, of which the record says nothing
        """
        first_s, last_s = self.times_s[0], self.times_s[-1]
        if not first_s - REACH_S <= time_s <= last_s + REACH_S:
            raise ParameterError(
                f"yaw file {self.name}: no rate for the frame at {time_s:.3f} s: covers {first_s:.3f}..{last_s:.3f} s, "
                f"must cover every frame that is looked at to within {REACH_S:g} s"
            )
        return float(np.interp(time_s, self.times_s, self.rates_deg_s))


def read_yaw(path: str | Path) -> YawRecord:
    """Return the record of a CSV file with the columns ``time_s,yaw_deg_s``; others may stand beside them.

    Raises
    ------
    ParameterError : no such file, a column missing, no rows, a value that is no finite number, or a time that does
        not increase, with its line
    """
    where = f"yaw file {path}"
    times_s: list[float] = []
    rates_deg_s: list[float] = []
    try:
        with Path(path).open(newline="", encoding="utf-8-sig") as text:
            rows = csv.DictReader(text)
            missing = [name for name in COLUMNS if name not in (rows.fieldnames or ())]
            if missing:
                raise ParameterError(
                    f"{where}: lacks the column {', '.join(missing)}: must begin with a heading that has "
                    f"{' and '.join(COLUMNS)}, parted by a comma"
                )
            for row in rows:
                time_s, rate_deg_s = (_number(row[name], name, f"{where}: line {rows.line_num}") for name in COLUMNS)
                if times_s and time_s <= times_s[-1]:
                    raise ParameterError(
                        f"{where}: line {rows.line_num}: time_s = {time_s:g} after {times_s[-1]:g}: must increase"
                    )
                times_s.append(time_s)
                rates_deg_s.append(rate_deg_s)
    except OSError as error:
        reason = "no such file" if isinstance(error, FileNotFoundError) else error.strerror
        raise ParameterError(f"{where}: {reason}") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise ParameterError(f"{where}: is not CSV: {error}") from error
    if not times_s:
        raise ParameterError(f"{where}: no rows: must hold at least one time and rate")
    return YawRecord(str(path), np.array(times_s), np.array(rates_deg_s))


def _number(text: str | None, column: str, where: str) -> float:
    try:
        value = float(text or "")
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ParameterError(f"{where}: {column} = {text or ''!r}: must be a finite number")
    return value
