"""Files, hosts, ports and passwords in a target. Messages name what is allowed, never what may hold a password."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple
from urllib.parse import SplitResult, unquote, urlsplit

from ..errors import ParameterError


def file_of(target: str, ending: str) -> Path:
    """Return the file of ``mcap:FILE.mcap``.

    Raises
    ------
    ParameterError : no file is named, or one with another ending
    """
    scheme, _, name = target.partition(":")
    if Path(name).suffix.lower() != ending:
        raise ParameterError(f"hook {target}: must be {scheme}:FILE{ending}")
    return Path(name)


class HostPort(NamedTuple):
    """A host, by name or number, and a port."""

    host: str
    port: int

    def __str__(self) -> str:
        return f"{_bracketed(self.host)}:{self.port}"


def host_port(text: str, target: str, wanted: str) -> HostPort:
    """Return ``robot:9000`` or ``[::1]:9000``, which is the end of ``target``, in its two parts.

    Raises
    ------
    ParameterError : another form; the message says ``wanted``
    """
    match = re.fullmatch(r"(\[[0-9a-fA-F:.%]+\]|[^\s:/@\[\]]+):(\d{1,5})", text)
    if match is None or not 1 <= int(match[2]) <= 65535:
        raise ParameterError(f"hook {target}: must be {wanted}, port 1 to 65535")
    return HostPort(match[1].strip("[]"), int(match[2]))


class Url(NamedTuple):
    """A target such as ``mqtt://user:password@host:1883/topic``; ``path`` begins with its slash and has the query."""

    scheme: str
    user: str | None
    password: str | None
    address: HostPort
    path: str

    @property
    def shown(self) -> str:
        """Scheme and host: nothing a log must not hold, not even a path, which can be a secret too."""
        return f"{self.scheme}://{self.address}"


def split_url(target: str, default_port: int, wanted: str) -> Url:
    """Return ``target`` in its parts; user and password may be percent-encoded.

    Raises
    ------
    ParameterError : another form; the message says ``wanted``
    """
    try:
        parts = urlsplit(target)
        host, port = parts.hostname, default_port if parts.port is None else parts.port
    except ValueError:  # a port that is no number, brackets that do not close
        host, port = None, 0
    if not host or port == 0 or re.search(r"[\s@]", host + parts.path) or parts.fragment:
        scheme = target.partition(":")[0].lower()
        raise ParameterError(
            f"hook {scheme}://...: must be {wanted}, port 1 to 65535; "
            "in a password % @ : / ? # are written %25 %40 %3A %2F %3F %23"
        )
    return Url(parts.scheme, _decoded(parts.username), _decoded(parts.password), HostPort(host, port), _path(parts))


def _path(parts: SplitResult) -> str:
    return parts.path + (f"?{parts.query}" if parts.query else "")


def _decoded(text: str | None) -> str | None:
    return None if text is None else unquote(text)


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host
