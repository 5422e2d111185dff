"""The errors lobula raises on purpose: each names what was given, what is allowed, and where."""


class LobulaError(Exception):
    """Base of every error raised on purpose."""


class ParameterError(LobulaError, ValueError):
    """A setting, argument or preset name outside what is allowed."""


class ShapeError(LobulaError, ValueError):
    """An image whose shape, dtype or values are not what the network reads."""


class TimeError(LobulaError, ValueError):
    """A time stamp that stands still, runs backwards or is not finite."""


class FrameSourceError(LobulaError, OSError):
    """A source that cannot be opened or that failed on the way.

    ``on_the_way`` is true when frames had already been delivered: what was written stays usable.
    """

    def __init__(self, message: str, *, on_the_way: bool = False) -> None:
        super().__init__(message)
        self.on_the_way = on_the_way


class OutputError(LobulaError, OSError):
    """An output that cannot be written: disk full, no such folder, encoder missing."""


class MissingExtraError(LobulaError, ImportError):
    """A feature whose optional dependency is not installed; the message holds the pip command."""


def pip_install(extra: str) -> str:
    """Return the commands that install an extra of lobula: from an index, and from a clone."""
    return f'pip install "lobula[{extra}]" (from a clone: pip install ".[{extra}]")'
