"""Names of ports, and lines that are there, in use, no lines, and gone."""

from __future__ import annotations

import errno
import os
import termios

import pytest

from lobula.errors import FrameSourceError, ParameterError
from lobula.telemetry import Port, SerialLine, parse_port, port


def test_names():
    assert parse_port("serial:/dev/ttyUSB0") == Port("/dev/ttyUSB0", 115200)
    assert parse_port("serial:/dev/ttyACM1@9600") == Port("/dev/ttyACM1", 9600)
    assert parse_port("serial:robot@921600") == Port("robot", 921600)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("serial:", "must be serial:PORT or serial:PORT@BAUD"),
        ("serial:@9600", "must be serial:PORT or serial:PORT@BAUD"),
        ("serial:/dev/ttyUSB0@", "must be serial:PORT or serial:PORT@BAUD"),
        ("serial:/dev/ttyUSB0@fast", "must be serial:PORT or serial:PORT@BAUD"),
        ("serial:/dev/ttyUSB0@-9600", "must be serial:PORT or serial:PORT@BAUD"),
        ("serial:/dev/ttyUSB0@9601", "9601 baud: must be one of 1200, "),
        ("serial:/dev/ttyUSB0@0", "0 baud: must be one of "),
        ("/dev/ttyUSB0", "must be serial:PORT or serial:PORT@BAUD"),
    ],
)
def test_wrong_names(text, says):
    with pytest.raises(ParameterError, match=says):
        parse_port(text)


def test_every_rate_is_one_of_the_system():
    assert {9600, 19200, 57600, 115200} <= set(port.RATES)
    assert port.RATES[115200] == termios.B115200


def test_bytes_come_as_they_were_sent_and_silence_is_empty(robot):
    line = SerialLine(parse_port(f"{robot.port}@57600"))
    every = bytes(range(256))  # carriage returns, end of file, interrupt, XON and XOFF among them
    robot.say(every)
    got = b""
    while len(got) < 256:
        got += line.read(5.0)
    assert got == every
    assert line.read(0.01) == b""
    assert termios.tcgetattr(line._fd)[5] == termios.B57600
    line.close()
    line.close()


def test_what_was_kept_from_before_is_thrown_away(robot):
    robot.say(b"long ago")
    line = SerialLine(parse_port(robot.port))
    assert line.read(0.05) == b""
    robot.say(b"now")
    assert line.read(5.0) == b"now"
    line.close()


def test_a_line_that_goes_away(robot):
    line = SerialLine(parse_port(robot.port))
    robot.unplug()
    with pytest.raises(FrameSourceError, match="the device went away") as caught:
        line.read(5.0)
    assert caught.value.on_the_way
    line.close()


def test_no_two_read_the_same_line(robot):
    first = SerialLine(parse_port(robot.port))
    with pytest.raises(FrameSourceError, match="in use by another program"):
        SerialLine(parse_port(robot.port))
    first.close()
    SerialLine(parse_port(robot.port)).close()


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ("none", "none: no such device"),
        ("", "is a folder: must be a serial line"),
        ("file", "file: is no serial line"),
    ],
)
def test_what_is_no_line(tmp_path, path, says):
    (tmp_path / "file").write_text("no line")
    with pytest.raises(FrameSourceError, match=says):
        SerialLine(Port(str(tmp_path / path), 115200))


def test_a_line_that_is_not_ours(monkeypatch):
    def refuse(*_):
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(FrameSourceError, match="no permission: you must be in the group of the device, mostly dialout"):
        SerialLine(Port("/dev/ttyUSB0", 115200))


def test_a_rate_that_the_device_does_not_take(robot, monkeypatch):
    monkeypatch.setattr(termios, "tcsetattr", lambda *_: None)
    with pytest.raises(FrameSourceError, match="does not run at 4800 baud: must be a rate of this device"):
        SerialLine(parse_port(f"{robot.port}@4800"))
    monkeypatch.undo()
    SerialLine(parse_port(robot.port)).close()  # and it was let go of
