"""This machine's figures: what a step, a stream and a decoded frame cost here. Needs NumPy alone; PyAV adds video."""

from .figures import measure

__all__ = ["measure"]
