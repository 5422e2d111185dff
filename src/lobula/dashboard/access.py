"""Who may see the page: under which names it is reached, and the token that opens it."""

from __future__ import annotations

import hashlib
import hmac
import ipaddress
import secrets
import socket
from collections.abc import Sequence
from dataclasses import dataclass

from ..errors import ParameterError

LEAST_TOKEN = 12
"""Characters of a token that somebody thought up."""


@dataclass(frozen=True)
class Access:
    """What a request must bring.

    ``names`` are the hosts that a request may name, lower case; ``any_address`` allows every IP address beside them:
    who makes a name of their own point here cannot make it look like an address. ``token`` is None where only this
    machine can ask and none was wished for. ``cookie`` is the name of the cookie that stands for it.
    """

    names: frozenset[str]
    any_address: bool
    token: str | None
    cookie: str

    @property
    def session(self) -> str:
        """Value of the cookie: gives nothing away of the token, and stays the same while the token does."""
        return hmac.new((self.token or "").encode(), b"lobula dashboard", hashlib.sha256).hexdigest()

    def names_this(self, host: str) -> bool:
        """Whether ``host``, the value of a Host header, names this page."""
        name = host_name(host)
        return name in self.names or (self.any_address and _is_address(name))

    def opened_by(self, *, token: str | None = None, session: str | None = None) -> bool:
        """Whether the token, or the cookie that stands for it, is the right one; without a token everybody may."""
        if self.token is None:
            return True
        right = token is not None and _same(token, self.token)
        return right or (session is not None and _same(session, self.session))


def access_to(host: str, port: int, token: str | None, also_known_as: Sequence[str] = ()) -> Access:
    """Return the access to a page served at ``host``; a token is made where one is needed and none is given.

    It is needed away from loopback, and on loopback where the page has other names: they are those of a proxy, and what
    comes through that comes from elsewhere.

    Raises
    ------
    ParameterError : a token that is too short, or one that cannot stand in a header
    """
    if token is not None and (len(token) < LEAST_TOKEN or not (token.isascii() and token.isprintable())):
        raise ParameterError(
            f"token of {len(token)} characters: must be at least {LEAST_TOKEN}, ASCII without controls"
        )
    names = {"localhost", "127.0.0.1", "::1", host_name(host), *(host_name(name) for name in also_known_as)}
    local = is_loopback(host)
    if not local:
        here = socket.gethostname().lower()
        names |= {here, f"{here}.local"}
    if not local or also_known_as:
        token = token or secrets.token_urlsafe(18)
    return Access(frozenset(names - {"0.0.0.0", "::"}), not local, token, f"lobula-{port}")


def is_loopback(host: str) -> bool:
    """Whether only this machine can reach a page served at ``host``."""
    return host.lower() == "localhost" or (_is_address(host) and ipaddress.ip_address(host).is_loopback)


def host_name(host: str) -> str:
    """Return the name or address in ``host``, which may carry a port: lower case, without brackets."""
    host = host.strip().lower()
    if host.startswith("["):
        return host[1:].partition("]")[0]
    return host if host.count(":") > 1 else host.partition(":")[0]


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _same(given: str, right: str) -> bool:
    return hmac.compare_digest(given.encode(), right.encode())
