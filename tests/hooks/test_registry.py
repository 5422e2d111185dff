"""Targets: which there are, which are refused and how, and that no password is ever repeated."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from urllib.parse import quote

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lobula.errors import LobulaError, MissingExtraError, ParameterError
from lobula.hooks import KINDS, Hook, make_hook
from lobula.hooks.address import split_url

passwords = st.text(st.characters(codec="utf-8", exclude_categories=("Cs", "Cc")), min_size=6, max_size=12).map(
    lambda text: f"Zz{text}zZ"
)


def test_every_kind_has_its_module():
    folder = Path(sys.modules[Hook.__module__].__file__).parent
    for scheme, kind in KINDS.items():
        assert (folder / f"{kind.module}.py").is_file(), scheme
        assert kind.form.startswith(f"{scheme}:")


@pytest.mark.parametrize("target", ["carrier-pigeon:nest", "nonsense", "", ":", "pigeon://me:secret@nest/t"])
def test_an_unknown_kind_is_told_which_there_are(target):
    with pytest.raises(ParameterError) as refused:
        make_hook(target)
    line = str(refused.value)
    assert all(kind.form in line for kind in KINDS.values())
    assert "\n" not in line
    assert "secret" not in line


@pytest.mark.parametrize(
    ("target", "says"),
    [
        ("ndjson:", "must be ndjson:FILE; records on standard output are --json"),
        ("ndjson:-", "must be ndjson:FILE; records on standard output are --json"),
        ("tcp:9000", "hook tcp:9000: must be tcp:HOST:PORT, port 1 to 65535"),
        ("tcp:host:0", "must be tcp:HOST:PORT, port 1 to 65535"),
        ("tcp:host:70000", "must be tcp:HOST:PORT, port 1 to 65535"),
        ("tcp:host:http", "must be tcp:HOST:PORT, port 1 to 65535"),
        ("tcp:::1:9000", "must be tcp:HOST:PORT, port 1 to 65535"),
        ("unix:", "must be unix:PATH with at most 107 bytes of path"),
        ("unix:/" + "a" * 107, "must be unix:PATH with at most 107 bytes of path"),
        ("http:host", "hook http://...: must be http[s]://[user:password@]host[:port]/path"),
        ("https://", "hook https://...: must be http[s]://"),
        ("http://host:0/x", "port 1 to 65535"),
        ("http://host:99999/x", "port 1 to 65535"),
        ("http://host/a b", "hook http://...: must be"),
        ("http://[::1/x", "hook http://...: must be"),
    ],
)
def test_targets_that_cannot_be(target, says):
    with pytest.raises(ParameterError) as refused:
        make_hook(target)
    assert says in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("target", "says"),
    [
        ("mqtt://host", "the topic without + and #"),
        ("mqtt://host/", "the topic without + and #"),
        ("mqtt://host/a/+/b", "the topic without + and #"),
        ("mqtt://host/a#b", "must be mqtt[s]://[user:password@]host[:port]/topic"),
        ("mqtt:host/topic", "must be mqtt[s]://[user:password@]host[:port]/topic"),
        ("mqtt://host:port/topic", "port 1 to 65535"),
    ],
)
def test_addresses_of_brokers_that_cannot_be(target, says):
    pytest.importorskip("paho.mqtt", reason="needs paho-mqtt 2, the extra mqtt")
    test_targets_that_cannot_be(target, says)


@pytest.mark.parametrize(
    ("target", "says"),
    [
        ("mavlink:", "must be mavlink:udpout|udpin|udpbcast|tcp:HOST:PORT or mavlink:/dev/DEVICE[,BAUD]"),
        ("mavlink:udpout:14550", "hook mavlink:udpout:14550: must be mavlink:udpout|"),
        ("mavlink:flight.tlog", "must be mavlink:udpout|"),
        ("mavlink:udpout:h:1?sysid=0", "?sysid=1 to 255 behind it"),
        ("mavlink:udpout:h:1?sysid=256", "?sysid=1 to 255 behind it"),
        ("mavlink:udpout:h:1?sys=1", "?sysid=1 to 255 behind it"),
        ("mavlink:/dev/ttyS0,fast", "must be mavlink:udpout|"),
    ],
)
def test_links_that_cannot_be(target, says):
    pytest.importorskip("pymavlink", reason="needs pymavlink (93 MB), the extra mavlink")
    test_targets_that_cannot_be(target, says)


@pytest.mark.parametrize(
    ("target", "name"),
    [
        ("http://host/secret", "http://host:80"),
        ("https://me:word@host", "https://host:443"),
        ("mqtt://me:word@host/robot/7", "mqtt://host:1883/robot/7"),
        ("mqtts://[::1]/t", "mqtts://[::1]:8883/t"),
        ("TCP:[::1]:9000", "tcp:[::1]:9000"),
    ],
)
def test_what_a_hook_is_called_and_the_port_if_none_is_given(target, name):
    if target.startswith("mqtt"):
        pytest.importorskip("paho.mqtt", reason="needs paho-mqtt 2, the extra mqtt")
    assert make_hook(target).name == name


@pytest.mark.parametrize(
    ("target", "library", "extra"),
    [
        ("mqtt://host/topic", "paho.mqtt.client", "mqtt"),
        ("mavlink:udpout:host:1", "pymavlink.dialects.v20", "mavlink"),
        ("mavlink:/dev/ttyS0", "serial", "mavlink"),
        ("foxglove:127.0.0.1:8765", "foxglove", "foxglove"),
        ("mcap:a.mcap", "mcap.writer", "mcap"),
        ("rosbag:new", "rosbags.rosbag2", "rosbags"),
        ("rerun:a.rrd", "rerun", "rerun"),
    ],
)
def test_a_library_that_is_not_there(monkeypatch, target, library, extra):
    if library == "serial":
        pytest.importorskip("pymavlink", reason="needs pymavlink (93 MB), the extra mavlink")
    else:
        monkeypatch.delitem(sys.modules, f"lobula.hooks.{KINDS[target.split(':')[0]].module}", raising=False)
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingExtraError, match=rf'pip install "lobula\[{extra}\]"'):
        make_hook(target)


@settings(max_examples=30)
@given(
    passwords, st.sampled_from(["http", "https", "mqtt", "mqtts"]), st.sampled_from(["/p", "", ":x/p", ":0", "/+", " "])
)
def test_a_password_is_in_no_name_and_no_message(password, scheme, rest):
    if scheme.startswith("mqtt"):
        pytest.importorskip("paho.mqtt", reason="needs paho-mqtt 2, the extra mqtt")
    for written in (password, quote(password, safe="")):  # as it is, and as it should be
        try:
            told = make_hook(f"{scheme}://me:{written}@host{rest}").name
        except LobulaError as refused:
            told = str(refused)
        assert written not in told
        assert password not in told


@settings(max_examples=30)
@given(passwords)
def test_a_password_arrives_as_it_was_encoded(password):
    url = split_url(f"mqtt://m%40e:{quote(password, safe='')}@host:1/t", 1883, "")
    assert (url.user, url.password, url.address, url.path) == ("m@e", password, ("host", 1), "/t")


def test_only_the_library_that_is_asked_for_is_loaded(monkeypatch):
    for name in list(sys.modules):
        if name.split(".")[0] in ("paho", "pymavlink", "serial"):
            monkeypatch.delitem(sys.modules, name)
    make_hook("tcp:host:1")
    import_module("lobula.hooks")
    assert not {name.split(".")[0] for name in sys.modules} & {"paho", "pymavlink", "serial"}
