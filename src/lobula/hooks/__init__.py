"""Where a run's events go: files, sockets, programs, webhooks, brokers, autopilots. No hook stalls or stops a run.

A target such as ``mqtt://broker/robot`` names a hook; ``make_hook`` makes it, ``PostOffice`` runs all hooks of a run as
one sink, and ``Telling`` lets the reader of the run know what became of them:

    loop thread                          one thread a hook
    PostOffice -> Post -> Mailbox  ...  Post -> Hook.connect, Hook.send

How to add a hook
-----------------
1. Write ``hooks/NAME.py`` with a subclass of ``Hook`` (``hook.py`` says what each call must do) and a function
   ``make(target: str) -> Hook`` that reads the target. A wrong target raises ``ParameterError``, a library that is not
   there ``MissingExtraError``; import that library inside the file that needs it. The hook only knows how to send:
   queue, thread, back-off, drops and what is told of them are the ``Post``'s.
2. Add one line to ``KINDS`` in ``registry.py``: scheme -> how a target is written, what it does, the module.
3. Add tests against the real protocol on loopback, and a section in docs/hooks.md.

A hook that wants every reading sets ``readings_hz = math.inf``, one that wants pictures ``pictures_hz``; one that
writes a file sets ``path`` and opens it in ``check``, so that a wrong place is told before the first frame.
"""

from .hook import Hook, RefusedError
from .message import Kind, Message, line
from .office import PostOffice
from .registry import KINDS, make_hook
from .telling import Telling

__all__ = ["KINDS", "Hook", "Kind", "Message", "PostOffice", "RefusedError", "Telling", "line", "make_hook"]
