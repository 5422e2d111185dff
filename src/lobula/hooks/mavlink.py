"""``mavlink:...``: alarms and potentials for an autopilot or a ground station. Needs the extra ``mavlink``.

It reports and never commands: the action in its COLLISION messages is "report". pymavlink is under the LGPL; it is
imported where the user installed it and no part of lobula.
"""

from __future__ import annotations

import math
import time

from ..errors import MissingExtraError, ParameterError, pip_install
from ..runtime.events import Record
from ..types import NEURONS
from .hook import Hook, RefusedError
from .mavlink_link import WANTED, Link, make_link
from .message import Message

try:
    from pymavlink.dialects.v20 import common as mavlink
except ImportError as error:
    raise MissingExtraError(f"hook mavlink needs pymavlink: {pip_install('mavlink')}") from error

SYSTEM_ID = 1
"""The system that most vehicles are; the obstacle sensor is a component of it."""

HEARTBEAT_S = 1.0
LATE_S = 2.0
"""A message that had to wait longer than this, s, is left out: nothing in it says how old it is."""


def make(target: str) -> Hook:
    """Return the hook of ``mavlink:LINK`` or ``mavlink:LINK?sysid=N``.

    Raises
    ------
    ParameterError : a link of another form, or a system that is not 1 to 255
    MissingExtraError : a serial line without pyserial
    """
    text, question, query = target.partition(":")[2].partition("?")
    name, _, number = query.partition("=")
    if question and (name != "sysid" or not number.isdecimal() or not 1 <= int(number) <= 255):
        raise ParameterError(f"hook {target}: must be {WANTED}, ?sysid=1 to 255 behind it if need be")
    return Mavlink(text, make_link(text), int(number) if question else SYSTEM_ID)


class Mavlink(Hook):
    """Sends COLLISION at the start of each, NAMED_VALUE_FLOAT for each potential of a reading, and a HEARTBEAT.

    ``time_boot_ms`` is the frame's own stamp, ``id`` the number of the collision in this run. What lobula cannot know
    (time to the collision, distances) is NaN. The heartbeat goes out with other messages, once a second at most, so it
    stops when readings stop.
    """

    kinds = frozenset({"event", "reading"})
    events_kept = 10
    readings_kept = 10

    def __init__(self, text: str, link: Link, system_id: int = SYSTEM_ID) -> None:
        super().__init__(f"mavlink:{text}")
        self._link = link
        self._mav = mavlink.MAVLink(link, srcSystem=system_id, srcComponent=mavlink.MAV_COMP_ID_OBSTACLE_AVOIDANCE)
        self._beaten_s = -math.inf

    def wants(self, message: Message) -> bool:
        """Of the events only the start of a collision."""
        record = message.record
        return message.kind == "reading" or (record["type"], record.get("phase")) == ("collision", "start")

    def connect(self, header: Record) -> None:
        """Open the link."""
        self._link.open()

    def send(self, message: Message) -> None:
        """Send the packets of one message, after a heartbeat if it is time for one.

        Raises
        ------
        RefusedError : the message is too old
        """
        if time.time() - message.record["unix_s"] > LATE_S:
            raise RefusedError(f"older than {LATE_S:g} s: left out")
        self._heartbeat()
        if message.kind == "reading":
            self._potentials(message.record)
        else:
            self._collision(message.record)

    def disconnect(self) -> None:
        """Close the link."""
        self._link.close()

    def _heartbeat(self) -> None:
        now_s = time.monotonic()
        if now_s - self._beaten_s >= HEARTBEAT_S:
            self._mav.heartbeat_send(
                mavlink.MAV_TYPE_ONBOARD_CONTROLLER, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, mavlink.MAV_STATE_ACTIVE
            )
            self._beaten_s = now_s

    def _potentials(self, record: Record) -> None:
        time_ms = _boot_ms(record)
        for name in NEURONS:
            self._mav.named_value_float_send(time_ms, name.encode(), record[name])

    def _collision(self, record: Record) -> None:
        self._mav.collision_send(
            mavlink.MAV_COLLISION_SRC_ADSB,  # the nearest there is: "another sensor, which numbers what it sees"
            record["id"],
            mavlink.MAV_COLLISION_ACTION_REPORT,
            mavlink.MAV_COLLISION_THREAT_LEVEL_HIGH,
            math.nan,
            math.nan,
            math.nan,
        )


def _boot_ms(record: Record) -> int:
    """The stamp as the 32 bits that the message has for it: round again after 49 days."""
    return int(1000 * record["time_s"]) % 2**32
