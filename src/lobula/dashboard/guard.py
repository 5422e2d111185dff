"""Stands before every request: meant for this page, sent by this page, by somebody who may; answers told to be careful.

A foreign site in the same browser is the main danger: it can send requests here (cross-site), or give its own name our
address (DNS rebinding). The first is told by Origin and Sec-Fetch-Site, the second by Host.
"""

from __future__ import annotations

from http.cookies import CookieError, SimpleCookie
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .access import Access
from .door import BusyError, Door

SECURITY_HEADERS = {
    "content-security-policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
        "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
    ),
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "same-origin",  # with no-referrer, browsers would say Origin: null of our own form
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}


class Guard:
    """ASGI application that hands on to ``app`` what is in order and answers the rest itself.

    ``unlocked`` are the paths that need no token: the page that asks for it, and what that page is made of. A request
    for another path without one is handed to ``login``. Whatever of these finds the ``door`` busy may leave it at that.
    """

    def __init__(self, app: ASGIApp, login: ASGIApp, access: Access, door: Door, unlocked: frozenset[str]) -> None:
        self._app = app
        self._login = login
        self._access = access
        self._door = door
        self._unlocked = unlocked

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""

        async def careful(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in SECURITY_HEADERS.items():
                    headers[name] = value
            await send(message)

        try:
            answer = await self._answer(scope, Headers(scope=scope))
            if scope["type"] == "http" or answer is self._app:
                await answer(scope, receive, careful)
                return
        except BusyError:
            if scope["type"] == "http":
                await _refused(429, "too many wrong tokens come in: try again in a moment")(scope, receive, careful)
                return
        await send({"type": "websocket.close", "code": 1008})  # before it is accepted: 403

    async def _answer(self, scope: Scope, headers: Headers) -> ASGIApp:
        hosts = headers.getlist("host")
        if len(hosts) != 1 or not self._access.names_this(hosts[0]):
            return _refused(421, "this page is not known by that host name: --allow-host NAME makes it so")
        if not _own_origin(headers, hosts[0]) or not _own_fetch(scope, headers):
            return _refused(403, "this request comes from another site")
        if scope["path"] not in self._unlocked and not await self._opened(headers):
            return self._login
        return self._app

    async def _opened(self, headers: Headers) -> bool:
        try:
            cookie = SimpleCookie(headers.get("cookie", "")).get(self._access.cookie)
        except CookieError:
            cookie = None
        if self._door.knows(None if cookie is None else cookie.value):
            return True
        scheme, _, token = headers.get("authorization", "").partition(" ")
        return scheme.lower() == "bearer" and await self._door.opens_to(token.strip())


def _own_origin(headers: Headers, host: str) -> bool:
    """Whether the page that sent the request, where it says so, is this one: same name, same port."""
    origins = headers.getlist("origin")
    if not origins:
        return True
    try:
        return len(origins) == 1 and urlsplit(origins[0].lower()).netloc == host.lower()
    except ValueError:  # it is no address at all
        return False


def _own_fetch(scope: Scope, headers: Headers) -> bool:
    """Whether the browser says that this page asks, the address bar, or a link that opens the page."""
    if headers.get("sec-fetch-site", "none") in ("none", "same-origin"):
        return True
    opens_page = headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"
    return bool(opens_page and scope.get("method") == "GET")


def _refused(status: int, reason: str) -> Response:
    return PlainTextResponse(f"{reason}\n", status)
