"""``http://`` and ``https://``: posts each event as JSON to an address."""

from __future__ import annotations

import base64
import http.client
import json
from urllib.parse import quote

from .._version import __version__
from .address import Url, split_url
from .hook import TIMEOUT_S, Hook, RefusedError
from .message import Message

_LATER = {408, 425, 429}
"""Answers of the 400s that ask for another try, as all of the 500s do."""


def make(target: str) -> Hook:
    """Return the hook of an ``http://`` or ``https://`` address.

    Raises
    ------
    ParameterError : no host, or a wrong port
    """
    default_port = 443 if target.lower().startswith("https:") else 80
    return Webhook(split_url(target, default_port, "http[s]://[user:password@]host[:port]/path"))


class Webhook(Hook):
    """Posts one record at a time. An answer of 200 to 299 is success; 500 and above are tried again, like no answer.

    No redirect is followed: a POST does not survive most of them.
    """

    kinds = frozenset({"event"})

    def __init__(self, url: Url) -> None:
        super().__init__(url.shown)
        self._url = url
        self._path = quote(url.path, safe="/?=&%:;,+!$'()*~[]") or "/"  # what is encoded already stays
        self._headers = {"Content-Type": "application/json", "User-Agent": f"lobula/{__version__}"}
        if url.user is not None:
            pair = f"{url.user}:{url.password or ''}".encode()
            self._headers["Authorization"] = f"Basic {base64.b64encode(pair).decode()}"

    def send(self, message: Message) -> None:
        """Post one record over a connection of its own.

        Raises
        ------
        RefusedError : the answer says that another try would be no better
        OSError : no answer, or one that asks for another try
        """
        kind = http.client.HTTPSConnection if self._url.scheme == "https" else http.client.HTTPConnection
        connection = kind(*self._url.address, timeout=TIMEOUT_S)
        try:
            body = json.dumps(message.record, allow_nan=False)
            connection.request("POST", self._path, body, self._headers)
            status = connection.getresponse().status
        except http.client.HTTPException as error:
            raise ConnectionError(f"no answer in HTTP ({type(error).__name__})") from error
        finally:
            connection.close()
        answer = f"answered {status} {http.client.responses.get(status, '')}".rstrip()
        if status >= 500 or status in _LATER:
            raise ConnectionError(answer)
        if not 200 <= status < 300:
            raise RefusedError(answer)
