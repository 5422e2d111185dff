"""A stand-in for rclpy and the message packages: no network, but as particular about the types of fields as ROS is.

Written from the public documentation of rclpy and the message definitions; it is no proof that a real ROS agrees.
"""

from __future__ import annotations

import array
import copy
import sys
import threading
import time
import types
from collections import deque

REQUIRED = {
    "builtin_interfaces.msg": {"Time": {"sec": 0, "nanosec": 0}},
    "std_msgs.msg": {
        "Header": {"stamp": "Time", "frame_id": ""},
        "Bool": {"data": False},
        "MultiArrayDimension": {"label": "", "size": 0, "stride": 0},
        "MultiArrayLayout": {"dim": [], "data_offset": 0},
        "Float64MultiArray": {"layout": "MultiArrayLayout", "data": [0.0]},
        "Int32MultiArray": {"layout": "MultiArrayLayout", "data": [0]},
    },
    "sensor_msgs.msg": {
        "Image": {
            "header": "Header", "height": 0, "width": 0, "encoding": "", "is_bigendian": 0, "step": 0,
            "data": array.array("B"),
        },
        "CompressedImage": {"header": "Header", "format": "", "data": array.array("B")},
    },
    "diagnostic_msgs.msg": {
        "KeyValue": {"key": "", "value": ""},
        "DiagnosticStatus": {"level": b"\0", "name": "", "message": "", "hardware_id": "", "values": []},
        "DiagnosticArray": {"header": "Header", "status": []},
    },
}  # fmt: skip


def message_classes():
    """Name -> class of each message, with keyword arguments that are checked as rclpy checks them."""
    classes = {}

    def checked(name, field, model, value):
        kind = classes[model] if isinstance(model, str) and model in classes else type(model)
        assert isinstance(value, kind), f"{name}.{field} = {value!r}: must be {kind.__name__}"
        if kind is bytes:
            assert len(value) == 1, f"{name}.{field}: one byte"
        if kind is list and model:
            assert all(type(one) is type(model[0]) for one in value), f"{name}.{field} = {value!r}"
        return value

    def make(name, fields):
        def __init__(self, **given):  # noqa: N807 - the constructor of the class that is made here
            assert set(given) <= set(fields), f"{name} has no {set(given) - set(fields)}"
            for field, model in fields.items():
                if isinstance(model, str) and model in classes:
                    default = classes[model]()
                else:
                    default = [] if isinstance(model, list) else copy.copy(model)
                setattr(self, field, checked(name, field, model, given.get(field, default)))

        return type(name, (), {"__init__": __init__, "__slots__": tuple(fields)})

    for package in REQUIRED.values():
        for name, fields in package.items():
            classes[name] = make(name, fields)
    return classes


class Ros:
    """What the stand-in's middleware saw: parameters to give, topics with what was published, the log."""

    def __init__(self, **parameters):
        self.parameters = parameters
        self.messages = message_classes()
        self.published = {}
        self.log = []
        self.running = False
        self.destroyed = False
        self.clock_ns = time.time_ns
        self._arrived = threading.Condition()
        self._queue = deque()
        self._subscriptions = {}

    def send(self, topic, message):
        """Deliver a picture as the middleware does: of those that wait, only so many as the subscriber keeps."""
        with self._arrived:
            kind, _, qos = self._subscriptions[topic]
            assert isinstance(message, kind)
            assert (qos.history, qos.reliability) == ("keep_last", "best_effort")
            while len(self._queue) >= qos.depth:
                self._queue.popleft()
            self._queue.append((topic, message))
            self._arrived.notify_all()

    def subscribed(self, topic):
        return topic in self._subscriptions

    def install(self, monkeypatch):
        """Put the stand-in where ``import rclpy`` and the messages are looked for."""
        for package, names in REQUIRED.items():
            module = types.ModuleType(package)
            for name in names:
                setattr(module, name, self.messages[name])
            monkeypatch.setitem(sys.modules, package.split(".")[0], types.ModuleType(package.split(".")[0]))
            monkeypatch.setitem(sys.modules, package, module)
        rclpy, qos, signals = (types.ModuleType(name) for name in ("rclpy", "rclpy.qos", "rclpy.signals"))
        rclpy.init, rclpy.create_node, rclpy.ok = self._init, lambda name: Node(self, name), lambda: self.running
        rclpy.spin_once, rclpy.try_shutdown = self._spin_once, self._shutdown
        qos.QoSProfile = types.SimpleNamespace
        qos.HistoryPolicy = types.SimpleNamespace(KEEP_LAST="keep_last")
        qos.ReliabilityPolicy = types.SimpleNamespace(BEST_EFFORT="best_effort")
        signals.SignalHandlerOptions = types.SimpleNamespace(NO="no")
        for module in (rclpy, qos, signals):
            monkeypatch.setitem(sys.modules, module.__name__, module)
        for name in ("ros2", "ros2_camera", "ros2_topics"):
            monkeypatch.delitem(sys.modules, f"lobula.hooks.{name}", raising=False)

    def _init(self, *, args, signal_handler_options):
        assert signal_handler_options == "no"
        self.running = True

    def _shutdown(self):
        self.running = False

    def _spin_once(self, node, *, timeout_sec):
        with self._arrived:
            self._arrived.wait_for(lambda: self._queue, timeout_sec)
            if not self._queue:
                return
            topic, message = self._queue.popleft()
        self._subscriptions[topic][1](message)


class Node:
    """The calls of a node that are used, and no others."""

    def __init__(self, ros, name):
        self._ros, self._name = ros, name

    def declare_parameter(self, name, default):
        return types.SimpleNamespace(value=self._ros.parameters.get(name, default))

    def create_subscription(self, kind, topic, callback, qos):
        self._ros._subscriptions[topic] = (kind, callback, qos)

    def create_publisher(self, kind, topic, depth):
        assert isinstance(depth, int)
        told = self._ros.published.setdefault(topic.replace("~", f"/{self._name}"), [])

        def publish(message):
            assert type(message) is kind
            told.append(message)

        return types.SimpleNamespace(publish=publish)

    def get_clock(self):
        now = types.SimpleNamespace(nanoseconds=self._ros.clock_ns())
        return types.SimpleNamespace(now=lambda: now)

    def get_logger(self):
        log = self._ros.log
        return types.SimpleNamespace(**{
            level: lambda text, level=level: log.append((level, text)) for level in ("info", "warning", "error")
        })  # fmt: skip

    def destroy_node(self):
        self._ros.destroyed = True
