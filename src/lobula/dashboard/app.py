"""The routes of the page, as an ASGI application."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from concurrent.futures import Executor
from typing import Any
from urllib.parse import parse_qs

from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, PlainTextResponse, RedirectResponse, Response
from starlette.routing import Route, Router, WebSocketRoute
from starlette.types import ASGIApp, Receive, Scope, Send

from ..errors import ParameterError
from ..model.network import NetworkParams
from .access import Access
from .board import Board
from .door import Door
from .guard import Guard
from .pages import page_files
from .viewer import Streams

MOST_BODY = 16_384
"""Bytes of a request's body; all settings at once take a tenth of it."""

BODY_S = 10.0
"""A body that has not come whole after this long is given up, s."""

Toml = Callable[[NetworkParams], str]
"""Writes settings as ``lobula run --config`` reads them."""


class _BodyError(Exception):
    """A body that is not taken; ``answer`` says why."""

    def __init__(self, status: int, reason: str) -> None:
        super().__init__(reason)
        self.answer = PlainTextResponse(f"{reason}\n", status, {"connection": "close"})


def make_app(board: Board, access: Access, executor: Executor, toml: Toml) -> ASGIApp:
    """Return the application that shows ``board`` to whom ``access`` lets in."""
    files, door = page_files(), Door(access)
    desk = _Desk(board, access, door, toml, files)
    shown = [name for name in files if not name.endswith(".html")]
    routes = [
        Route("/", desk.index, methods=["GET"]),
        Route("/login", desk.log_in, methods=["POST"]),
        Route("/settings", desk.change, methods=["POST"]),
        Route("/settings.toml", desk.download, methods=["GET"]),
        *(Route(f"/{name}", desk.file(name), methods=["GET"]) for name in shown),
        WebSocketRoute("/stream", Streams(board, executor).serve),
    ]
    unlocked = frozenset({"/login", "/theme.css", "/style.css", "/icon.svg"})
    return Guard(Router(routes, redirect_slashes=False), desk.locked, access, door, unlocked)


class _Desk:
    """Answers the ordinary requests."""

    def __init__(
        self, board: Board, access: Access, door: Door, toml: Toml, files: dict[str, tuple[str, bytes]]
    ) -> None:
        self._board = board
        self._access = access
        self._door = door
        self._toml = toml
        self._files = files

    def file(self, name: str) -> Callable[[Request], Any]:
        """Return the endpoint of one file."""
        media, content = self._files[name]

        async def give(request: Request) -> Response:
            return Response(content, media_type=media)

        return give

    async def index(self, request: Request) -> Response:
        """Give the page."""
        return self._page("index.html")

    async def locked(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer who has not shown the token; a browser that opens the page may bring it in the address, or type it in.

        No redirect after that: a browser that followed a link from elsewhere would not send the cookie along with it.
        """
        request = Request(scope, receive)
        given = request.query_params.get("token")
        if request.method != "GET" or scope["path"] != "/":
            answer: Response = PlainTextResponse("a token is needed\n", 401, {"www-authenticate": "Bearer"})
        elif given is None:
            answer = self._page("login.html", 401)
        elif await self._door.opens_to(given):
            answer = self._with_cookie(self._page("index.html"))
        else:
            answer = self._wrong_token()
        await answer(scope, receive, send)

    async def log_in(self, request: Request) -> Response:
        """Take the token from the form."""
        try:
            given = parse_qs((await _body(request)).decode("ascii", "replace")).get("token", [""])[0]
        except _BodyError as error:
            return error.answer
        if not await self._door.opens_to(given):
            return self._wrong_token()
        return self._with_cookie(RedirectResponse("/", 303))

    async def change(self, request: Request) -> Response:
        """Change settings, {path: value}, or all of them back, {"restore": true}; the answer is what holds now."""
        settings = self._board.settings
        if settings is None:
            return PlainTextResponse("nothing can be changed here\n", 409)
        if request.headers.get("content-type", "").partition(";")[0].strip().lower() != "application/json":
            return PlainTextResponse("must be application/json\n", 415)
        try:
            asked = json.loads(await _body(request))
            if not isinstance(asked, dict) or not asked:
                raise ParameterError("must be {PATH: VALUE, ...}")
            if asked.keys() == {"restore"} and asked["restore"] is True:
                settings.restore()
            else:
                settings.change(asked)
        except _BodyError as error:
            return error.answer
        except ParameterError as error:
            return PlainTextResponse(f"{error}\n", 422)
        except (ValueError, RecursionError):
            return PlainTextResponse("must be JSON\n", 400)
        return JSONResponse(settings.values())

    async def download(self, request: Request) -> Response:
        """Give the present settings as a file for ``lobula run --config``."""
        settings = self._board.settings
        if settings is None:
            return PlainTextResponse("a saved trace: its settings are not known\n", 404)
        headers = {"content-disposition": 'attachment; filename="lobula-settings.toml"'}
        return Response(self._toml(settings.params), media_type="application/toml", headers=headers)

    def _page(self, name: str, status: int = 200) -> Response:
        media, content = self._files[name]
        return Response(content, status, media_type=media)

    def _with_cookie(self, response: Response) -> Response:
        response.set_cookie(self._access.cookie, self._access.session, httponly=True, samesite="strict", path="/")
        return response

    def _wrong_token(self) -> Response:
        media, content = self._files["login.html"]
        return Response(content.replace(b"<!--wrong-->", b"<p>That was not it.</p>"), 401, media_type=media)


async def _body(request: Request) -> bytes:
    """Return the body, read no further than it may be long, and for no longer than it may take."""
    body = b""
    try:
        async with asyncio.timeout(BODY_S):
            async for chunk in request.stream():
                body += chunk
                if len(body) > MOST_BODY:
                    raise _BodyError(413, f"must be at most {MOST_BODY} bytes")
    except ClientDisconnect:
        raise _BodyError(400, "was cut off") from None
    except TimeoutError:
        raise _BodyError(408, f"must come within {BODY_S:g} s") from None
    return body
