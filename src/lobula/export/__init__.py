"""Settings as a folder of C for a robot: the core's own sources, and a header with every setting in it."""

from .config_header import config_header
from .folder import EXAMPLE, c_folder
from .memory import STACK, in_kib, largest_size, require_ram, state_bytes

__all__ = ["EXAMPLE", "STACK", "c_folder", "config_header", "in_kib", "largest_size", "require_ram", "state_bytes"]
