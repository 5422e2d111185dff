"""A gyroscope's record: read row by row, and asked for the rate at a frame's time."""

from __future__ import annotations

import pytest

from lobula.errors import ParameterError
from lobula.runtime.yaw import read_yaw


def record(folder, rows, heading="time_s,yaw_deg_s"):
    path = folder / "yaw.csv"
    path.write_text("\n".join([heading, *rows]) + "\n", encoding="utf-8")
    return read_yaw(path)


@pytest.mark.parametrize(
    ("time_s", "rate_deg_s"),
    [(1.0, 10.0), (1.25, 17.5), (1.5, 25.0), (2.0, 40.0), (3.0, -10.0), (4.0, -60.0)],
)
def test_the_rate_is_linear_between_rows(tmp_path, time_s, rate_deg_s):
    found = record(tmp_path, ["1,10", "2,40", "4,-60"])  # 30 deg/s a second, then -50
    assert found.at(time_s) == pytest.approx(rate_deg_s)


def test_the_nearest_row_holds_for_half_a_second_outside(tmp_path):
    found = record(tmp_path, ["1,10", "2,40"])
    assert (found.at(0.5), found.at(2.5)) == (10.0, 40.0)
    for time_s in (0.499, 2.501, 1.7e9):
        with pytest.raises(
            ParameterError, match=r"no rate for the frame at .* s: covers 1\.000\.\.2\.000 s, must cover"
        ):
            found.at(time_s)


def test_one_row_is_a_record(tmp_path):
    assert record(tmp_path, ["0,-90"]).at(0.5) == -90.0


def test_other_columns_their_order_and_a_byte_order_mark_do_not_matter(tmp_path):
    found = record(tmp_path, ["x, 5 ,0", "y,7,1", ""], heading="\ufeffnote,yaw_deg_s,time_s")
    assert found.at(0.5) == 6.0


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "lacks the column time_s, yaw_deg_s: must begin with a heading that has time_s and yaw_deg_s"),
        ("time_s,yaw\n0,1\n", "lacks the column yaw_deg_s: must begin with a heading"),
        ("0,1\n1,2\n", "lacks the column time_s, yaw_deg_s: must begin with a heading"),
        ("time_s;yaw_deg_s\n0;1\n", "parted by a comma"),
        ("time_s,yaw_deg_s\n", "no rows: must hold at least one time and rate"),
        ("time_s,yaw_deg_s\n0,1\n1,fast\n", "line 3: yaw_deg_s = 'fast': must be a finite number"),
        ("time_s,yaw_deg_s\n0,nan\n", "line 2: yaw_deg_s = 'nan': must be a finite number"),
        ("time_s,yaw_deg_s\ninf,1\n", "line 2: time_s = 'inf': must be a finite number"),
        ("time_s,yaw_deg_s\n0\n", "line 2: yaw_deg_s = '': must be a finite number"),
        ("time_s,yaw_deg_s\n0,1\n0,2\n", "line 3: time_s = 0 after 0: must increase"),
        ("time_s,yaw_deg_s\n1,1\n0.5,2\n", "line 3: time_s = 0.5 after 1: must increase"),
        ("time_s,yaw_deg_s\n0,\udcff\n", "is not CSV"),
    ],
)
def test_bad_records_are_refused_in_one_line(tmp_path, text, says):
    path = tmp_path / "yaw.csv"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(ParameterError) as refused:
        read_yaw(path)
    assert str(refused.value).startswith(f"yaw file {path}: ")
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


def test_no_such_file_and_a_folder(tmp_path):
    with pytest.raises(ParameterError, match=r"none\.csv: no such file"):
        read_yaw(tmp_path / "none.csv")
    with pytest.raises(ParameterError, match="Is a directory"):
        read_yaw(tmp_path)
