"""Real Dask clusters on this machine: one with two worker processes, others within this process."""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
from types import SimpleNamespace

import pytest

from lobula.batch import cluster as module
from lobula.batch import find_clips, run_batch, work
from lobula.batch.cluster import LOCAL, Cluster
from lobula.batch.lines import Lines
from lobula.batch.places import work_folder
from lobula.errors import MissingExtraError, OutputError, ParameterError

from .conftest import Alone, write_clip

really_do = module._do
begun: list[str] = []
gone = threading.Event()


def do_and_be_killed(request, clip):
    """In a worker: the first of the workers that comes to its second clip is killed in the middle of it."""
    begun.append(clip.name)
    if len(begun) == 2:
        try:
            (request.out / "killed").touch(exist_ok=False)
            work.run_loop = lambda *_: os.kill(os.getpid(), signal.SIGKILL)
        except FileExistsError:
            pass
    return really_do(request, clip)


def do_one_and_wait(request, clip):
    """In a worker of this process: the second clip takes until the scheduler has gone."""
    begun.append(clip.name)
    if len(begun) > 1:
        assert gone.wait(60)
    return really_do(request, clip)


def cannot_work(request, clip):
    raise ModuleNotFoundError("No module named 'lobula'")


def test_without_dask(ask, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=r"^--cluster needs Dask: pip install \"lobula\[dask\]\""):
        Cluster(ask(), 2, LOCAL)


@pytest.mark.parametrize(
    "address", ["", "0", "nonsense", "10.0.0.1:8786", "ftp://x:1", "tcp://", "tcp://x", "ws://x:1"]
)
def test_what_is_no_address(ask, address):
    with pytest.raises(ParameterError, match=f"^--cluster {address}: must be dask, or an address such as tcp://"):
        Cluster(ask(), 1, address)


@pytest.mark.parametrize("workers", [0, 257])
def test_workers_out_of_range(ask, workers):
    with pytest.raises(ParameterError, match=f"^workers = {workers}: must be 1 to 256$"):
        Cluster(ask(), workers, LOCAL)


class TestWithDask:
    @pytest.fixture(autouse=True)
    def _dask(self):
        self.distributed = pytest.importorskip("distributed", reason="needs the extra dask, too large for the tests")
        self.dask = pytest.importorskip("dask")

    @pytest.fixture
    def clips(self, tmp_path, out):
        """Lay clips into a folder, and a file that is none."""

        def lay(count):
            for seed in range(count):
                write_clip(tmp_path / "clips" / f"{seed}.mp4", seed, frames=10)
            (tmp_path / "clips" / "empty.mp4").touch()
            return find_clips([str(tmp_path / "clips")], out)

        return lay

    def there(self, workers=1):
        """Make a cluster whose workers are threads of this process."""
        return self.distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=False, protocol="tcp", dashboard_address=None
        )

    def done_once(self, out, count):
        rows = [row for row in Lines(out / "manifest.ndjson").new() if row["status"] == "ok"]
        assert len(rows) == len({row["content"] for row in rows}) == count
        assert all((out / row["trace"]).is_file() for row in rows)

    def test_one_of_two_workers_is_killed_and_nothing_is_lost_or_done_twice(self, ask, out, clips, monkeypatch):
        monkeypatch.setattr(module, "_do", do_and_be_killed)
        asked = ask()
        ended = run_batch(clips(6), asked, Cluster(asked, 2, LOCAL))
        assert (out / "killed").exists()
        assert ended.stop is None
        assert (ended.summary.ok, ended.summary.failed, ended.summary.unfinished) == (6, 1, 0)
        self.done_once(out, 6)
        assert list(work_folder(out).iterdir()) == []

    def test_a_cluster_that_is_there_already(self, ask, out, clips):
        with self.there() as there:
            asked = ask()
            cluster = Cluster(asked, 7, there.scheduler_address)
            ended = run_batch(clips(2), asked, cluster)
        assert (ended.summary.ok, ended.summary.failed, ended.summary.workers) == (2, 1, 1)
        self.done_once(out, 2)

    def test_the_scheduler_goes_away_in_the_middle(self, ask, out, clips, monkeypatch):
        monkeypatch.setattr(module, "_do", do_one_and_wait)
        begun.clear()
        gone.clear()
        asked, found = ask(), clips(3)
        there = self.there()
        try:
            cluster = Cluster(asked, 1, there.scheduler_address)
            ended = run_batch(found, asked, cluster, lambda row: there.sync(there.scheduler.close))
        finally:
            gone.set()
            with self.dask.config.set({"distributed.comm.timeouts.connect": 0.1}):  # it looks for the scheduler
                there.close()
        assert isinstance(ended.stop, OutputError)
        assert str(ended.stop).endswith(": the scheduler is gone; what was finished by then is kept")
        assert (ended.summary.ok, ended.summary.unfinished) == (1, 3)
        again = run_batch(found, asked, Alone(asked))
        assert (again.summary.ok, again.summary.failed, again.summary.unfinished) == (3, 1, 0)
        assert again.summary.kept >= 1
        self.done_once(out, 3)

    def test_nobody_is_at_the_address(self, ask, monkeypatch):
        monkeypatch.setattr(module, "_ANSWERS_IN_S", 0.5)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
            with pytest.raises(ParameterError, match=f"^--cluster {address}: no Dask scheduler answers: Timed out"):
                Cluster(ask(), 1, address).__enter__()

    def test_a_cluster_without_workers(self, ask, monkeypatch):
        monkeypatch.setattr(module, "_ANSWERS_IN_S", 0.5)
        with (
            self.there(workers=0) as there,
            pytest.raises(ParameterError, match=r": has no worker: must have one at least$"),
        ):
            Cluster(ask(), 1, there.scheduler_address).__enter__()

    def test_a_worker_that_cannot_work_ends_the_batch(self, ask, clips, monkeypatch):
        monkeypatch.setattr(module, "_do", cannot_work)
        with self.there() as there:
            asked = ask()
            ended = run_batch(clips(2), asked, Cluster(asked, 1, there.scheduler_address))
        assert isinstance(ended.stop, OutputError)
        assert "a worker cannot work: ModuleNotFoundError" in str(ended.stop)

    def test_a_clip_that_kills_every_worker_fails_alone(self, ask):
        def result():
            raise self.distributed.KilledWorker("task", "worker", 4)

        told = Cluster(ask(), 1, LOCAL)._outcome(SimpleNamespace(result=result))
        assert told == "its worker ended in the middle of it, again and again"
