"""A real Dask cluster on this machine."""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import time

import pytest

from lobula.batch import find_clips, run_batch
from lobula.batch.cluster import LOCAL, Cluster
from lobula.batch.lines import Lines
from lobula.errors import LobulaError, MissingExtraError, ParameterError

from .conftest import write_clip

CLIPS = 20


def test_without_dask(ask, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(MissingExtraError, match=r"^--cluster needs Dask: pip install \"lobula\[dask\]\""):
        Cluster(ask(), 2, LOCAL)


class TestWithDask:
    @pytest.fixture(autouse=True)
    def _dask(self):
        self.distributed = pytest.importorskip("distributed", reason="needs the extra dask, too large for the tests")

    @pytest.fixture
    def clips(self, tmp_path, out):
        for seed in range(CLIPS):
            write_clip(tmp_path / "clips" / f"{seed}.mp4", seed, frames=60)
        (tmp_path / "clips" / "empty.mp4").touch()
        return find_clips([str(tmp_path / "clips")], out)

    def test_one_of_two_workers_is_killed_and_nothing_is_lost_or_done_twice(self, ask, out, clips):
        asked, killed = ask(), []
        cluster = Cluster(asked, 2, LOCAL)

        def kill_one(row):
            if killed or row.status != "ok":
                return
            assert len(Lines(out / "manifest.ndjson").new()) < CLIPS  # there is work left
            workers = cluster._client.run(os.getpid)
            killed.append(next(iter(workers.values())))
            os.kill(killed[0], signal.SIGKILL)

        ended = run_batch(clips, asked, cluster, kill_one)
        assert killed
        assert ended.stop is None
        assert (ended.summary.ok, ended.summary.failed, ended.summary.unfinished) == (CLIPS, 1, 0)
        manifest = Lines(out / "manifest.ndjson").new()
        done = [row["content"] for row in manifest if row["status"] == "ok"]
        assert len(done) == len(set(done)) == CLIPS
        assert {row.content for row in ended.rows if row.status == "ok"} == set(done)
        for row in manifest:
            assert row["status"] == "failed" or (out / row["trace"]).is_file()

    def test_a_cluster_that_is_there_already(self, ask, out, clips):
        with self.distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as there:
            asked = ask()
            cluster = Cluster(asked, 1, there.scheduler_address)
            ended = run_batch(clips[:3], asked, cluster)
            assert (ended.summary.ok, cluster.workers) == (3, 1)

    def test_nobody_is_at_the_address(self, ask, monkeypatch):
        monkeypatch.setattr("lobula.batch.cluster._ANSWERS_IN_S", 0.5)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        with pytest.raises(
            ParameterError, match=f"^--cluster tcp://127.0.0.1:{port}: no Dask scheduler answers: must be"
        ):
            Cluster(ask(), 1, f"tcp://127.0.0.1:{port}").__enter__()

    @pytest.mark.parametrize("address", ["nonsense", "ftp://x:1", "tcp://"])
    def test_what_is_no_address(self, ask, monkeypatch, address):
        monkeypatch.setattr("lobula.batch.cluster._ANSWERS_IN_S", 0.5)
        with pytest.raises(ParameterError, match=f"^--cluster {address}: no Dask scheduler answers: must be"):
            Cluster(ask(), 1, address).__enter__()

    def test_a_cluster_without_workers(self, ask, monkeypatch):
        monkeypatch.setattr("lobula.batch.cluster._ANSWERS_IN_S", 0.5)
        with (
            self.distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=None) as there,
            pytest.raises(ParameterError, match=r": has no worker: must have one at least$"),
        ):
            Cluster(ask(), 1, there.scheduler_address).__enter__()

    def test_the_scheduler_goes_away_in_the_middle(self, ask, out, clips):
        there = self.distributed.LocalCluster(n_workers=1, processes=False, dashboard_address=None)
        asked = ask()

        def leave(row):
            threading.Thread(target=there.close).start()
            time.sleep(0.5)

        ended = run_batch(clips, asked, Cluster(asked, 1, there.scheduler_address), leave)
        assert isinstance(ended.stop, LobulaError)
        assert ended.summary.unfinished > 0
