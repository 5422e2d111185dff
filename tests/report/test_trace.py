"""The trace: same rows back from every format, all rows after a crash, one line for every failure."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lobula.errors import FrameSourceError, MissingExtraError, OutputError, ParameterError
from lobula.report.trace import TraceWriter
from lobula.report.trace_file import TRACE_SUFFIXES, read_about, read_trace
from lobula.types import TRACE_DTYPE, Reading, Spikes

from .approach import FRAMES, HEADER, SUMMARY, play, table

CONTRACT = (
    "frame,time_s,lgmd1,lgmd2,lptc_r,lptc_l,spikes_lgmd1,spikes_lgmd2,spikes_lptc_r,spikes_lptc_l,"
    "collision,state"
)  # as DESIGN.md prints it


@pytest.mark.parametrize("suffix", TRACE_SUFFIXES)
def test_reads_back_equal(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"t{suffix}"
    play(TraceWriter(path))
    trace = read_trace(path)
    assert trace.dtype == TRACE_DTYPE
    assert np.array_equal(trace, table())
    assert list(tmp_path.iterdir()) == [path]


def test_csv_is_the_contract_and_nothing_else(tmp_path: Path) -> None:
    play(TraceWriter(tmp_path / "t.csv"))
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert lines[0] == CONTRACT
    assert lines[19] == "18,1.8,0.9,0.8,0.1,0.0,2,1,0,0,1,ok"
    assert len(lines) == FRAMES + 1


def test_jsonl_has_one_record_a_line(tmp_path: Path) -> None:
    play(TraceWriter(tmp_path / "t.jsonl"))
    records = [json.loads(line) for line in (tmp_path / "t.jsonl").read_text().splitlines()]
    assert list(records[0]) == CONTRACT.split(",")
    assert records[18]["collision"] is True
    assert records[0]["state"] == "warming_up"


@pytest.mark.parametrize("suffix", [".npz", ".parquet"])
def test_about_remembers_the_run(tmp_path: Path, suffix: str) -> None:
    play(TraceWriter(tmp_path / f"t{suffix}"))
    about = read_about(tmp_path / f"t{suffix}")
    assert {key: about[key] for key in ("settings_hash", "version", "source")} == {
        "settings_hash": "0123456789ab",
        "version": "0.1.0",
        "source": "clip.mp4",
    }
    assert about["summary"]["status"] == "ok"
    assert "settings" not in about


@settings(max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(value=st.floats(allow_nan=False), suffix=st.sampled_from(TRACE_SUFFIXES))
def test_numbers_survive_to_the_last_bit(tmp_path: Path, value: float, suffix: str) -> None:
    writer = TraceWriter(tmp_path / f"t{suffix}")
    writer.open(HEADER)
    writer.frame(0, Reading(value, value, value, value, value, Spikes(), False, "ok"), None)
    writer.close(SUMMARY)
    assert [read_trace(writer.path)[0][i] for i in range(1, 6)] == [value] * 5


@pytest.mark.parametrize(
    ("suffix", "left"), [(".csv", "t.csv"), (".jsonl", "t.jsonl"), (".npz", "t.part.csv"), (".parquet", "t.part.csv")]
)
def test_without_close_every_row_is_there(tmp_path: Path, suffix: str, left: str) -> None:
    writer = TraceWriter(tmp_path / f"t{suffix}")
    play(writer, finish=False)
    assert np.array_equal(read_trace(tmp_path / left), table())
    writer.close(SUMMARY)


@pytest.mark.parametrize("suffix", [".csv", ".jsonl"])
def test_torn_last_line_is_left_out(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"t{suffix}"
    play(TraceWriter(path))
    path.write_bytes(path.read_bytes()[:-3])  # "ok\n" -> "" and "}\n" with its quote -> torn
    assert np.array_equal(read_trace(path), table()[:-1])


def test_last_line_without_its_break_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    play(TraceWriter(path))
    path.write_bytes(path.read_bytes().rstrip(b"\n"))
    assert len(read_trace(path)) == FRAMES


@pytest.mark.parametrize("suffix", TRACE_SUFFIXES)
def test_no_frames_leave_an_empty_trace(tmp_path: Path, suffix: str) -> None:
    play(TraceWriter(tmp_path / f"t{suffix}"), frames=0)
    assert len(read_trace(tmp_path / f"t{suffix}")) == 0


def test_columns_may_be_shuffled_and_joined_by_others(tmp_path: Path) -> None:
    names = ["note", *reversed(CONTRACT.split(","))]
    (tmp_path / "t.csv").write_text(",".join(names) + '\n"a, b",ok,true,0,0,0,1,-0.5,0.25,0.5,0.75,0.1,7\n')
    row = read_trace(tmp_path / "t.csv")[0]
    assert row.item() == (7, 0.1, 0.75, 0.5, 0.25, -0.5, 1, 0, 0, 0, True, "ok")


@pytest.mark.parametrize("read", [read_trace, TraceWriter])
def test_unknown_suffix_says_what_is_allowed(read: object) -> None:
    with pytest.raises(ParameterError, match=r"^trace t\.txt: must end in \.csv, \.jsonl, \.npz, \.parquet$"):
        read("t.txt")  # type: ignore[operator]


def test_missing_column_is_named(tmp_path: Path) -> None:
    (tmp_path / "t.csv").write_text("frame,time_s\n0,0.0\n")
    with pytest.raises(FrameSourceError, match=r"t\.csv: lacks lgmd1, lgmd2") as caught:
        read_trace(tmp_path / "t.csv")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "bad",
    ["x,0.1,0.5,0.5,0,0,0,0,0,0,0,ok", "0,0.1,0.5,0.5,0,0,0,0,0,0,2,ok", "0,0.1,0.5,0.5,0,0,0,0,0,0,0,sleepy", "0,0.1"],
)
def test_bad_row_is_named_by_its_line(tmp_path: Path, bad: str) -> None:
    good = "0,0.1,0.5,0.5,0,0,0,0,0,0,0,ok"
    (tmp_path / "t.csv").write_text(f"{CONTRACT}\n{good}\n{bad}\n{good}\n")
    with pytest.raises(FrameSourceError, match=r"t\.csv: line 3: not a row of a trace: "):
        read_trace(tmp_path / "t.csv")


@pytest.mark.parametrize("suffix", TRACE_SUFFIXES)
def test_missing_file_and_nonsense_are_one_line(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"t{suffix}"
    with pytest.raises(FrameSourceError, match="no such file"):
        read_trace(path)
    path.write_bytes(b"\xff\xfe nonsense\n\x00 more\n")
    with pytest.raises(FrameSourceError) as caught:
        read_trace(path)
    assert "\n" not in str(caught.value)


def test_npz_of_something_else(tmp_path: Path) -> None:
    np.savez(tmp_path / "t.npz", other=np.arange(3))
    with pytest.raises(FrameSourceError, match=r"t\.npz: holds no trace: must be what lobula run --trace wrote"):
        read_trace(tmp_path / "t.npz")


@pytest.mark.parametrize("suffix", TRACE_SUFFIXES)
def test_no_such_folder(tmp_path: Path, suffix: str) -> None:
    writer = TraceWriter(tmp_path / "none" / f"t{suffix}")
    with pytest.raises(OutputError, match="no such folder"):
        writer.open(HEADER)
    writer.close(SUMMARY)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_full_disk(tmp_path: Path) -> None:
    (tmp_path / "t.csv").symlink_to("/dev/full")
    writer = TraceWriter(tmp_path / "t.csv")
    with pytest.raises(OutputError, match="the disk is full"):
        writer.open(HEADER)
    writer.close(SUMMARY)


def test_failed_end_keeps_the_rows_and_says_where(tmp_path: Path) -> None:
    writer = TraceWriter(tmp_path / "t.npz")
    play(writer, finish=False)
    (tmp_path / "t.npz").mkdir()  # something is in the way
    with pytest.raises(OutputError, match=r"it is a folder; the rows are in .*t\.part\.csv"):
        writer.close(SUMMARY)
    assert len(read_trace(tmp_path / "t.part.csv")) == FRAMES


def test_parquet_without_pyarrow_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("pyarrow", "pyarrow.parquet"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(MissingExtraError, match=r'pip install "lobula\[parquet\]"'):
        TraceWriter(tmp_path / "t.parquet")
    (tmp_path / "t.parquet").touch()
    with pytest.raises(MissingExtraError, match=r'pip install "lobula\[parquet\]"'):
        read_trace(tmp_path / "t.parquet")
