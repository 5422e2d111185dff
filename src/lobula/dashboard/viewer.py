"""The stream to one viewer: whatever is newest when it can take more; what it asks for is checked, then heeded."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from concurrent.futures import Executor
from contextlib import suppress
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from ..model.network import TAPS
from .board import Board, Viewer
from .messages import message
from .scene import Scene

MOST_VIEWERS = 16
BEAT_S = 4.0
"""A viewer hears something at least this often, s, so that it can tell a dead line from a quiet source."""

SEND_S = 10.0
"""A viewer that takes nothing for so long is let go, s."""

_TRY_LATER, _WRONG = 1013, 1008


class Streams:
    """The endpoint of the stream. ``executor`` has one thread, in which the scenes of a recording are made."""

    def __init__(self, board: Board, executor: Executor) -> None:
        self._board = board
        self._executor = executor

    async def serve(self, socket: WebSocket) -> None:
        """Serve one viewer until it goes."""
        await socket.accept()
        if len(self._board.viewers) >= MOST_VIEWERS:
            await socket.close(_TRY_LATER, f"{MOST_VIEWERS} viewers are the most")
            return
        viewer = Viewer()
        self._board.join(viewer)
        tasks = [asyncio.create_task(self._feed(socket, viewer)), asyncio.create_task(self._heed(socket, viewer))]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        except (WebSocketDisconnect, TimeoutError):
            pass
        finally:
            self._board.leave(viewer)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)

    async def _feed(self, socket: WebSocket, viewer: Viewer) -> None:
        """Send what is new, each time the viewer has taken what went before; now and then though nothing is."""
        while True:
            with suppress(TimeoutError):
                async with asyncio.timeout(BEAT_S):
                    await viewer.wake.wait()
            viewer.wake.clear()
            scene = await self._scene(viewer)
            data, more = message(self._board, viewer, scene)
            if more:
                viewer.wake.set()
            async with asyncio.timeout(SEND_S):
                await socket.send_bytes(data)

    async def _scene(self, viewer: Viewer) -> Scene | None:
        """The scene the viewer lacks, if any."""
        board = self._board
        if board.scenes is None:
            scene = board.scene
            if scene is None or scene.number == viewer.scene_number:
                return None
            viewer.scene_number = scene.number
            return scene
        if viewer.row is None or not len(board.rows):
            return None
        row, map_name = viewer.row, viewer.map
        key = board.scenes.key(row, map_name)
        if key == viewer.scene_key:
            return None
        viewer.scene_key = key
        return await asyncio.get_running_loop().run_in_executor(self._executor, board.scenes.at, row, map_name)

    async def _heed(self, socket: WebSocket, viewer: Viewer) -> None:
        """Take what the viewer asks for: a map, and in a recording the row it stands at."""
        while True:
            received = await socket.receive()
            if received["type"] == "websocket.disconnect":
                return
            try:
                wishes = _wishes(received.get("text"))
            except (ValueError, RecursionError) as error:
                await socket.close(_WRONG, str(error)[:100])
                return
            for heed, value in wishes:
                heed(self._board, viewer, value)


def _choose_map(board: Board, viewer: Viewer, name: str | None) -> None:
    board.choose_map(viewer, name)


def _show(board: Board, viewer: Viewer, row: int) -> None:
    viewer.row = row
    viewer.wake.set()


def _wishes(text: str | None) -> list[tuple[Callable[[Board, Viewer, Any], None], Any]]:
    """Return what a message asks for.

    Raises
    ------
    ValueError, RecursionError : it is not one of ours
    """
    asked = None if text is None else json.loads(text)
    if not isinstance(asked, dict) or not asked or not asked.keys() <= {"map", "show"}:
        raise ValueError('must be {"map": NAME} or {"show": ROW}')
    wishes: list[tuple[Callable[[Board, Viewer, Any], None], Any]] = []
    if "map" in asked:
        if asked["map"] is not None and asked["map"] not in TAPS:
            raise ValueError("map: must be the name of a map, or null")
        wishes.append((_choose_map, asked["map"]))
    if "show" in asked:
        row = asked["show"]
        if not isinstance(row, int) or isinstance(row, bool) or not 0 <= row < 1 << 32:
            raise ValueError("show: must be the number of a row")
        wishes.append((_show, row))
    return wishes
