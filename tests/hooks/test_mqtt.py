"""MQTT against a real broker: what subscribers get, and a broker that dies, freezes, refuses, comes back."""

from __future__ import annotations

import shutil
import signal
import socket
import subprocess

import pytest

from lobula.hooks import make_hook

from .brokers import Broker, Subscriber, program
from .listeners import LineServer, free_port
from .office import END, HEADER, START, SUMMARY, delivered, event, opened, reading, wait_until
from .test_webhook import make_certificate

pytest.importorskip("paho.mqtt", reason="needs paho-mqtt 2, the extra mqtt")
from paho.mqtt.client import MQTTErrorCode, MQTTMessageInfo

from lobula.hooks import mqtt
from lobula.hooks.message import told


@pytest.fixture
def broker(tmp_path):
    broker = Broker(tmp_path, "allow_anonymous true")
    yield broker
    broker.kill()


@pytest.fixture
def subscriber(broker):
    subscriber = Subscriber(broker.port)
    yield subscriber
    subscriber.close()


def at(broker, rest="/robot/7", user="", scheme="mqtt"):
    return f"{scheme}://{user}127.0.0.1:{broker.port}{rest}"


def test_each_record_under_a_topic_of_its_own(broker, subscriber):
    tally = delivered(make_hook(at(broker)), START, END, readings=[reading(0.0, 0.75)])
    wait_until(lambda: subscriber.of("robot/7/online") == [1, 0])
    assert subscriber.of("robot/7/header")[0]["source"] == HEADER["source"]
    collisions = subscriber.of("robot/7/collision")
    assert [c.pop("unix_s") > 0 for c in collisions] == [True, True]
    assert collisions == [START, END]
    assert [r["lgmd1"] for r in subscriber.of("robot/7/reading")] == [0.75]
    assert [s["frames"] for s in subscriber.of("robot/7/summary")] == [3]
    assert {name: qos for name, _, _, qos in subscriber.got}["robot/7/collision"] == 1
    assert {name: qos for name, _, _, qos in subscriber.got}["robot/7/reading"] == 0
    name = f"mqtt://127.0.0.1:{broker.port}/robot/7"
    assert tally == {"hook": name, "sent": 4, "dropped": 0, "failures": 0}


def test_who_comes_later_is_told_the_header_and_no_old_alarm(broker):
    delivered(make_hook(at(broker)), START)
    late = Subscriber(broker.port)
    wait_until(lambda: len(late.got) == 2)
    assert {(name, retained) for name, _, retained, _ in late.got} == {
        ("robot/7/header", True),
        ("robot/7/online", True),
    }
    late.close()


def test_a_broker_that_dies_and_comes_back(broker, subscriber):
    office = opened(make_hook(at(broker)))
    office.event(event(0))
    wait_until(lambda: subscriber.of("robot/7/state"))
    subscriber.close()
    broker.kill()
    office.event(event(1))
    wait_until(lambda: office.tallies()[0]["failures"] > 1)
    broker.start()
    again = Subscriber(broker.port)
    office.event(event(2))
    office.close(SUMMARY)
    wait_until(lambda: again.of("robot/7/online") == [1, 0] or again.of("robot/7/online") == [0])
    states = [s["frame"] for s in again.of("robot/7/state")]
    assert states in ([1, 2], [2])  # 1 may have come before the listener was back
    (tally,) = office.tallies()
    assert (tally["sent"], tally["dropped"]) == (4, 0)
    assert [r["phase"] for r in office.news()] == ["start", "end"]
    again.close()


def test_a_broker_that_freezes_and_thaws(broker, subscriber, monkeypatch):
    monkeypatch.setattr(mqtt, "TIMEOUT_S", 0.2)
    monkeypatch.setattr(mqtt, "_GOODBYE_S", 0.1)
    office = opened(make_hook(at(broker)))
    office.event(event(0))
    wait_until(lambda: subscriber.of("robot/7/state"))
    broker.send_signal(signal.SIGSTOP)
    office.event(event(1))
    wait_until(lambda: office.tallies()[0]["failures"])
    broker.send_signal(signal.SIGCONT)
    wait_until(lambda: office.tallies()[0]["sent"] == 2)
    office.close(SUMMARY)
    wait_until(lambda: 1 in [s["frame"] for s in subscriber.of("robot/7/state")])
    assert office.tallies()[0]["problem"].startswith("the broker ")


def test_a_lobula_that_is_cut_off_goes_offline_by_itself(broker, subscriber):
    hook = make_hook(at(broker))
    office = opened(hook)
    office.event(event(0))
    wait_until(lambda: subscriber.of("robot/7/state"))
    hook._client.socket().shutdown(socket.SHUT_RDWR)  # what a killed process looks like to the broker
    wait_until(lambda: subscriber.of("robot/7/online")[-1] == 0)
    office.close(SUMMARY)


def test_a_line_that_breaks_while_a_record_is_written_loses_nothing():
    class Breaking:
        """A client whose line is gone, though it has not heard of it yet."""

        def publish(self, *_):
            handed = MQTTMessageInfo(1)
            handed.rc = MQTTErrorCode.MQTT_ERR_CONN_LOST
            return handed

        def is_connected(self):
            return True

    hook = make_hook("mqtt://host/topic")
    hook._client = Breaking()
    with pytest.raises(ConnectionResetError):  # an OSError: the record is sent again
        hook.send(told("event", START))


def test_nobody_there(tmp_path):
    assert delivered(make_hook(f"mqtt://127.0.0.1:{free_port()}/t"), START)["problem"] == "Connection refused"


def test_something_that_is_no_broker(monkeypatch):
    monkeypatch.setattr(mqtt, "TIMEOUT_S", 0.2)
    server = LineServer()
    tally = delivered(make_hook(f"mqtt://127.0.0.1:{server.at[1]}/t"), START)
    assert (tally["sent"], tally["problem"]) == (0, "the broker does not answer")
    server.close()


def test_user_and_password(tmp_path):
    passwords = tmp_path / "passwords"
    subprocess.run([program("mosquitto_passwd"), "-b", "-c", passwords, "me", "se:cr@t"], check=True)
    broker = Broker(tmp_path, f"password_file {passwords}")
    try:
        right = delivered(make_hook(at(broker, user="me:se%3Acr%40t@")), START)
        wrong = delivered(make_hook(at(broker, user="me:guess%40@")), START)
        none = delivered(make_hook(at(broker)), START)
    finally:
        broker.kill()
    assert (right["sent"], right["failures"]) == (2, 0)
    for tally in (wrong, none):
        assert (tally["sent"], tally["problem"]) == (0, "the broker answers: Not authorized")
    assert "se:cr" not in str(right)
    assert "guess" not in str(wrong)


@pytest.mark.skipif(shutil.which("openssl") is None, reason="needs openssl to make a certificate")
def test_an_encrypted_line(tmp_path, monkeypatch):
    own = make_certificate(tmp_path)
    broker = Broker(tmp_path, "allow_anonymous true", f"certfile {own}", f"keyfile {own}")
    try:
        monkeypatch.setenv("SSL_CERT_FILE", str(own))
        assert delivered(make_hook(at(broker, scheme="mqtts")), START)["sent"] == 2
        monkeypatch.delenv("SSL_CERT_FILE")
        stranger = delivered(make_hook(at(broker, scheme="mqtts")), START)
    finally:
        broker.kill()
    assert (stranger["sent"], "CERTIFICATE_VERIFY_FAILED" in stranger["problem"]) == (0, True)
