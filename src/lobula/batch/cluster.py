"""The same clips over a Dask cluster: one on this machine, or one whose scheduler is given by its address."""

from __future__ import annotations

import logging
import re
import threading
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from functools import partial
from importlib import import_module
from types import TracebackType
from typing import Any, Self

from ..errors import LobulaError, MissingExtraError, OutputError, ParameterError, pip_install
from ..workers import check_workers, starting_workers
from .clips import Clip
from .crew import Outcome
from .request import Request
from .work import Answer, Desk

LOCAL = "dask"
"""The address of a cluster that is made for this batch, on this machine."""

_ADDRESS = re.compile(r"(tcp|tls)://[^/\s]+:\d+")
_ANSWERS_IN_S = 10.0
_LOGS = ("distributed", "distributed.client")

_desks = threading.local()
"""In a worker: the desk of each of its threads, with the request that it is for."""


class Cluster:
    """A context with a Dask cluster; ``each`` does with it what ``Crew.each`` does with processes.

    When it ends, what was not begun is taken back. A cluster elsewhere finishes, and keeps, what it is at.

    The clips and the output folder must be there under the same path for every worker. A worker that dies is replaced,
    its clips go to others; Dask does so three times for each clip.

    Raises
    ------
    ParameterError : what is no address, no cluster there, or no worker in it; workers out of range
    MissingExtraError : Dask is not installed
    """

    def __init__(self, request: Request, workers: int, address: str) -> None:
        if address != LOCAL and not _ADDRESS.fullmatch(address):
            raise ParameterError(f"--cluster {address}: must be {LOCAL}, or an address such as tcp://10.0.0.1:8786")
        check_workers(workers)
        self._request = request
        self._address = address
        self._open = ExitStack()
        self._dask = _distributed()
        self.workers = workers

    def __enter__(self) -> Self:
        for name in _LOGS:
            logging.getLogger(name).setLevel(logging.CRITICAL)  # what matters of what they tell, we tell
        with ExitStack() as opening:
            if self._address == LOCAL:
                with starting_workers():  # they stay deaf to the terminal: Dask leaves the signals as they are
                    cluster = self._dask.LocalCluster(
                        n_workers=self.workers, threads_per_worker=1, memory_limit=0, dashboard_address=None,
                        silence_logs=logging.CRITICAL,
                    )  # fmt: skip
                self._client = opening.enter_context(self._dask.Client(opening.enter_context(cluster)))
            else:
                self._client = opening.enter_context(self._connected())
            self._open = opening.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._open.close()

    def each(self, clips: Iterable[Clip]) -> Iterator[tuple[Clip, Outcome]]:
        """Yield each clip and what became of it, as they are finished.

        Raises
        ------
        LobulaError : what ends the whole batch: an output that cannot be written, a worker with other code
        OutputError : the cluster is gone
        """
        chosen = list(clips)
        futures = self._client.map(partial(_do, self._request), chosen, pure=False)
        of = dict(zip(futures, chosen, strict=True))
        for future in self._dask.as_completed(futures):
            yield of.pop(future), self._outcome(future)

    def _outcome(self, future: Any) -> Outcome:
        """Return what became of a clip; an answer that died with its worker is asked for again, from another one."""
        try:
            answer: Answer | LobulaError = future.result()
        except self._dask.KilledWorker:
            return "its worker ended in the middle of it, again and again"
        except Exception as error:
            told = f"a worker cannot work: {error!r}" if future.status == "error" else "the scheduler is gone"
            raise OutputError(f"--cluster {self._address}: {told}; what was finished by then is kept") from error
        if isinstance(answer, LobulaError):
            raise answer
        return answer

    def _connected(self) -> Any:
        """Connect to the scheduler and see that there is a worker."""
        try:
            client = self._dask.Client(self._address, timeout=_ANSWERS_IN_S)
        except (OSError, ValueError, TypeError) as error:  # no answer; a port that is none; tls:// without keys
            raise ParameterError(f"--cluster {self._address}: no Dask scheduler answers: {error}") from error
        try:
            client.wait_for_workers(1, timeout=_ANSWERS_IN_S)
        except TimeoutError as error:
            client.close()
            raise ParameterError(f"--cluster {self._address}: has no worker: must have one at least") from error
        self.workers = len(client.scheduler_info(n_workers=-1)["workers"])
        return client


def _do(request: Request, clip: Clip) -> Answer | LobulaError:
    """Do a clip in a worker; an error that ends the batch is an answer: Dask would print it on every machine."""
    try:
        if getattr(_desks, "request", None) != request:
            _desks.desk, _desks.request = Desk(request), request
        answer: Answer = _desks.desk.do(clip)
    except LobulaError as error:
        return error
    return answer


def _distributed() -> Any:
    try:
        return import_module("distributed")
    except ImportError as error:
        raise MissingExtraError(f"--cluster needs Dask: {pip_install('dask')}") from error
