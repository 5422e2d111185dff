"""A ROS 2 node that watches a camera: ``python -m lobula.hooks.ros2_node --ros-args -p topic:=/camera/image_raw``.

Parameters: ``topic``, raw pictures or, with a name that ends in ``/compressed``, JPEG or PNG; ``preset``. Needs the
rclpy of a sourced ROS 2. It publishes what it sees and commands nothing.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any

from ..engine.network import Network
from ..errors import LobulaError, MissingExtraError
from ..model.presets import preset
from ..runtime.header import run_header
from ..runtime.interrupts import Interrupted, raised_at_once
from ..runtime.loop import run as run_loop
from ..runtime.outputs import Outputs
from ..runtime.sinks import Picture
from ..types import Reading
from . import ros_words as words
from .office import PostOffice
from .telling import Telling

DEFAULT_TOPIC = "/camera/image_raw"


class Log:
    """A sink that says events in the log of the node."""

    def __init__(self, logger: Any) -> None:
        self._logger = logger

    def open(self, header: Mapping[str, Any]) -> None:
        """Say what is looked at."""
        self._logger.info(f"watching {header['source']} with preset {header['preset']}, engine {header['engine']}")

    def frame(self, index: int, reading: Reading, picture: Picture | None) -> None:
        """Say nothing."""

    def event(self, record: Mapping[str, Any]) -> None:
        """Say an event; loudly if something is wrong."""
        status = words.status(record)
        (self._logger.info if status.level == words.OK else self._logger.warning)(status.message)

    def close(self, summary: Mapping[str, Any]) -> None:
        """Say how it ended."""
        self._logger.info(f"{summary['frames']} frames, {summary['collisions']} collisions")


def main(args: Sequence[str] | None = None) -> int:
    """Run the node until Ctrl-C or SIGTERM and return the exit code."""
    try:
        from .ros2 import SignalHandlerOptions, rclpy
    except MissingExtraError as error:
        print(f"lobula: {error}", file=sys.stderr)
        return 2
    # lobula handles the signals itself: it ends with a summary
    rclpy.init(args=None if args is None else list(args), signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node("lobula")
    try:
        return _watch(node)
    except Interrupted as stop:
        return stop.exit_code
    except LobulaError as error:
        node.get_logger().error(str(error))
        return 2
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def _watch(node: Any) -> int:
    from .ros2_camera import Ros2Camera, Ros2Frames
    from .ros2_topics import Ros2Topics

    logger = node.get_logger()
    name = _parameter(node, "preset", "default")
    params = preset(name)
    network = Network(params)
    topic = _parameter(node, "topic", DEFAULT_TOPIC)
    logger.info(f"waiting for pictures on {topic}")
    with raised_at_once():
        camera = Ros2Camera(node, topic)
    frames = Ros2Frames(camera)
    office = PostOffice([Ros2Topics(node, camera.header)])
    outputs = Outputs([office, Telling(Log(logger), office)], logger.error)
    outcome = run_loop(frames, network, outputs, run_header(frames, params, preset=name, engine=network.engine))
    if outcome.message:
        logger.error(outcome.message)
    return outcome.exit_code


def _parameter(node: Any, name: str, default: str) -> str:
    return str(node.declare_parameter(name, default).value)


if __name__ == "__main__":
    sys.exit(main())
