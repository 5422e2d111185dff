"""What the node needs of ROS 2, from the environment that was sourced; none of it can be had from a package index."""

from __future__ import annotations

from ..errors import MissingExtraError

try:
    import rclpy
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
    from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
    from rclpy.signals import SignalHandlerOptions
    from sensor_msgs.msg import CompressedImage, Image
    from std_msgs.msg import Bool, Float64MultiArray, Int32MultiArray, MultiArrayDimension, MultiArrayLayout
except ImportError as error:
    raise MissingExtraError(
        f"the ROS 2 node needs {error.name or 'rclpy'}: source /opt/ros/DISTRO/setup.bash first, of a ROS 2 that is "
        "made for this version of Python"
    ) from error

__all__ = [
    "Bool",
    "CompressedImage",
    "DiagnosticArray",
    "DiagnosticStatus",
    "Float64MultiArray",
    "HistoryPolicy",
    "Image",
    "Int32MultiArray",
    "KeyValue",
    "MultiArrayDimension",
    "MultiArrayLayout",
    "QoSProfile",
    "ReliabilityPolicy",
    "SignalHandlerOptions",
    "rclpy",
]
