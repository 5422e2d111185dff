"""A process that does clips for as long as there are any; it starts once and ends with the process that started it."""

from __future__ import annotations

from contextlib import suppress
from multiprocessing.connection import Connection

from ..errors import LobulaError
from ..runtime.interrupts import Interrupted
from ..workers import begin_worker
from .work import Desk

READY = "ready"


def serve(line: Connection) -> None:
    """Take a request from ``line``, then clips, and answer each; an error that ends the batch is an answer as well."""
    begin_worker()
    with suppress(EOFError, ConnectionError, Interrupted):  # nobody waits for an answer
        try:
            desk = Desk(line.recv())
            line.send(READY)
            while True:
                line.send(desk.do(line.recv()))
        except LobulaError as error:
            line.send(error)
