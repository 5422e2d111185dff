"""Every route of a real server, and everything it must refuse."""

from __future__ import annotations

import errno
import re
import socket
import time
import tomllib

import numpy as np
import pytest
from websockets.exceptions import InvalidStatus

import lobula
from lobula.cli.settings import choose
from lobula.dashboard import app, door, prompt_http, viewer
from lobula.dashboard.about import about_run, board_of_trace
from lobula.dashboard.app import MOST_BODY
from lobula.dashboard.board import Board
from lobula.dashboard.live_settings import LiveSettings
from lobula.dashboard.rows import Rows
from lobula.dashboard.server import Site
from lobula.errors import ParameterError
from lobula.types import TRACE_DTYPE

from .stage import Watcher, ask, toml

FILES = [
    "app.js", "stream.js", "record.js", "ink.js", "traces.js", "picture.js", "timeline.js", "events.js", "settings.js",
    "words.js", "style.css", "theme.css", "icon.svg",
]  # fmt: skip
TOKEN = "correct horse battery"


def board():
    settings = LiveSettings(lobula.preset(), "default")
    return Board(about_run("live", {"source": "camera"}, settings), Rows(), settings=settings)


@pytest.fixture(scope="module")
def site():
    with Site(board(), toml) as site:
        yield site


@pytest.fixture(scope="module")
def locked():
    with Site(board(), toml, token=TOKEN) as site:
        yield site


class TestWhatThereIs:
    def test_the_page(self, site):
        page = ask(site, "/")
        assert (page.status, page.headers["content-type"]) == (200, "text/html; charset=utf-8")
        assert "<title>lobula</title>" in page.text

    @pytest.mark.parametrize("name", FILES)
    def test_its_files(self, site, name):
        file = ask(site, f"/{name}")
        kinds = {"js": "text/javascript", "css": "text/css", "svg": "image/svg+xml"}
        assert (file.status, file.headers["content-type"]) == (200, f"{kinds[name.split('.')[1]]}; charset=utf-8")
        assert len(file.body) > 100

    def test_nothing_comes_from_elsewhere(self, site):
        page, files = ask(site, "/").text, [ask(site, f"/{name}").text for name in FILES]
        for text in [page, *files]:
            assert set(re.findall(r"https?://[\w.]+", text)) <= {"http://www.w3.org"}  # the name of SVG
        wanted = set(re.findall(r'(?:src|href)="/([^"]+)"', page)) | set(
            re.findall(r'from "\./([^"]+)"', "".join(files))
        )
        assert wanted - {"settings.toml"} <= set(FILES)

    @pytest.mark.parametrize("path", ["/", "/app.js", "/none", "/settings.toml"])
    def test_every_answer_tells_the_browser_to_be_careful(self, site, path):
        headers = ask(site, path).headers
        assert "default-src 'none'" in headers["content-security-policy"]
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["x-frame-options"] == "DENY"
        assert headers["referrer-policy"] == "same-origin"
        assert headers["cache-control"] == "no-store"
        assert "server" not in headers
        assert "access-control-allow-origin" not in headers

    def test_settings_as_a_file_that_run_reads(self, site, tmp_path):
        changed = ask(site, "/settings", "POST", {"decision.collision_spikes": 7, "lptc.sigmoid_grey2": 0.004})
        assert changed.status == 200
        assert changed.document["values"]["decision.collision_spikes"] == 7
        file = ask(site, "/settings.toml")
        assert "attachment" in file.headers["content-disposition"]
        tomllib.loads(file.text)
        path = tmp_path / "mine.toml"
        path.write_bytes(file.body)
        params = choose(config=path).params
        assert (params.decision.collision_spikes, params.lptc.sigmoid_grey2) == (7, 0.004)
        restored = ask(site, "/settings", "POST", {"restore": True})
        assert restored.document["values"]["decision.collision_spikes"] == 4
        path.write_bytes(ask(site, "/settings.toml").body)
        assert choose(config=path).params == lobula.preset()

    def test_a_saved_trace_has_no_settings(self):
        with Site(board_of_trace(np.zeros(1, TRACE_DTYPE), {}, "t.csv"), toml) as site:
            assert ask(site, "/settings", "POST", {"decision.collision_spikes": 7}).status == 409
            assert ask(site, "/settings.toml").status == 404


class TestWhatIsRefused:
    @pytest.mark.parametrize(
        "path",
        [
            "/none", "/index.html", "/login.html", "/assets/", "/assets/app.js", "/app.js/", "//app.js", "/./app.js",
            "/../app.js", "/..%2fapp.js", "/%2e%2e/%2e%2e/etc/passwd", "/../../../../etc/passwd", "/app.js%00.css",
            "/..\\app.py", "/app.py", "/settings.toml/..", "//evil.example/", "/%2F%2Fevil.example", "/~root",
            "/?/../x/../..",
        ],
    )  # fmt: skip
    def test_path_tricks(self, site, path):
        answer = ask(site, path)
        if path.startswith("/?"):
            assert answer.status == 200  # only a query
            return
        assert answer.status in (400, 404)
        assert "location" not in answer.headers
        assert b"root:" not in answer.body
        assert b"import" not in answer.body

    @pytest.mark.parametrize(
        ("method", "path"),
        [("POST", "/"), ("PUT", "/settings"), ("GET", "/settings"), ("DELETE", "/settings.toml"), ("PATCH", "/app.js"),
         ("TRACE", "/"), ("OPTIONS", "/settings"), ("GET", "/login"), ("POST", "/settings.toml"), ("BREW", "/")],
    )  # fmt: skip
    def test_wrong_methods(self, site, method, path):
        assert ask(site, path, method).status == 405

    @pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "192.168.0.9", "", "localhost\u00e9"])
    def test_another_name_with_our_address(self, site, host):
        for path in ("/", "/app.js", "/settings.toml", "/none"):
            answer = ask(site, path, headers={"Host": host})
            assert answer.status in (400, 421)
            assert b"<html" not in answer.body
        assert ask(site, "/settings", "POST", {"restore": True}, {"Host": host}).status in (400, 421)

    @pytest.mark.parametrize("host", ["localhost", "LOCALHOST:1", "127.0.0.1:9999", "[::1]:80"])
    def test_our_own_names_as_through_a_tunnel(self, site, host):
        assert ask(site, "/", headers={"Host": host}).status == 200

    @pytest.mark.parametrize("lines", [b"", b"Host: localhost\r\nHost: localhost\r\n"])
    def test_no_host_or_two(self, site, lines):
        with socket.create_connection(("127.0.0.1", site.port), 10) as raw:
            raw.sendall(b"GET / HTTP/1.1\r\n" + lines + b"Connection: close\r\n\r\n")
            status = int(raw.recv(4096).split()[1])
        assert status in (400, 421)

    @pytest.mark.parametrize(
        "origin",
        ["http://evil.example", "null", "http://localhost:1", "https://127.0.0.1", "file://", "http://127.0.0.1",
         "http://[", "http://]127.0.0.1[", ""],
    )  # fmt: skip
    def test_another_site(self, site, origin, caplog):
        refused = ask(site, "/settings", "POST", {"decision.collision_spikes": 9}, {"Origin": origin})
        assert refused.status == 403
        assert "collision_spikes = 4 " in ask(site, "/settings.toml").text
        with pytest.raises(InvalidStatus, match="403"), Watcher(site, origin=origin):
            pass
        assert caplog.records == []  # nor is it an accident that ends in a traceback

    def test_our_own_site(self, site):
        own = {"Origin": f"http://127.0.0.1:{site.port}"}
        assert ask(site, "/settings", "POST", {"restore": True}, own).status == 200
        with Watcher(site, origin=own["Origin"]) as watcher:
            assert watcher.take().head["hello"]["name"] == "camera"

    @pytest.mark.parametrize(
        ("how", "status"),
        [
            ({"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "no-cors", "Sec-Fetch-Dest": "image"}, 403),
            ({"Sec-Fetch-Site": "same-site", "Sec-Fetch-Mode": "cors", "Sec-Fetch-Dest": "empty"}, 403),
            ({"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "iframe"}, 403),
            ({"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}, 200),
            ({"Sec-Fetch-Site": "none", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}, 200),
        ],
    )
    def test_what_the_browser_says_of_the_asker(self, site, how, status):
        assert ask(site, "/", headers=how).status == status

    def test_a_form_of_another_site_cannot_change_settings(self, site):
        """What a form can send without asking first: three content types, and the browser's own Origin."""
        for kind in ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""):
            answer = ask(site, "/settings", "POST", '{"decision.collision_spikes": 9}', {"Content-Type": kind})
            assert answer.status == 415

    @pytest.mark.parametrize(
        ("body", "status", "says"),
        [
            ("{", 400, "must be JSON"),
            ("[" * 5000, 400, "must be JSON"),
            (b"\xff\xfe", 400, "must be JSON"),
            ("[]", 422, "must be {PATH: VALUE, ...}"),
            ("{}", 422, "must be {PATH: VALUE, ...}"),
            ('{"decision.collision_spikes": 0}', 422, "decision.collision_spikes = 0: must be int in [1, 100]"),
            ('{"decision.collision_spikes": NaN}', 422, "must be int"),
            ('{"__class__": 1}', 422, "cannot be changed here"),
            ('{"restore": 1}', 422, "cannot be changed here"),
        ],
    )
    def test_wrong_settings(self, site, body, status, says):
        answer = ask(site, "/settings", "POST", body, {"Content-Type": "application/json"})
        assert answer.status == status
        assert says in answer.text
        assert answer.text.count("\n") == 1
        assert answer.headers["content-type"].startswith("text/plain")

    @pytest.mark.parametrize("path", ["/settings", "/login"])
    def test_huge_bodies(self, site, path):
        kind = {"Content-Type": "application/json"}
        assert ask(site, path, "POST", b" " * (MOST_BODY + 1), kind).status == 413
        with socket.create_connection(("127.0.0.1", site.port), 10) as raw:  # says nothing of its length, never ends
            raw.sendall(
                f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                "Transfer-Encoding: chunked\r\n\r\n".encode()
            )
            try:
                for _ in range(2000):
                    raw.sendall(b"1000\r\n" + b" " * 0x1000 + b"\r\n")
            except OSError:
                pass  # cut off, as it should be
            else:
                assert raw.recv(100).split()[1] == b"413"

    @pytest.mark.parametrize("path", ["/settings", "/login"])
    def test_a_body_that_does_not_come(self, site, monkeypatch, path):
        monkeypatch.setattr(app, "BODY_S", 0.2)
        with socket.create_connection(("127.0.0.1", site.port), 10) as raw:
            raw.sendall(
                f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                'Content-Length: 9\r\n\r\n{"'.encode()
            )
            assert raw.recv(100).split()[1] == b"408"

    def test_a_body_that_is_cut_off_is_nobodys_fault(self, site, caplog):
        with socket.create_connection(("127.0.0.1", site.port), 10) as raw:
            raw.sendall(b"POST /login HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\nto")
        assert ask(site, "/").status == 200
        assert caplog.records == []  # no traceback on the terminal of whoever serves it

    def test_who_never_says_what_it_wants_is_let_go(self, monkeypatch):
        monkeypatch.setattr(prompt_http, "REQUEST_S", 0.2)
        monkeypatch.setattr(viewer, "BEAT_S", 0.1)
        whole = b"GET /icon.svg HTTP/1.1\r\nHost: localhost\r\n\r\n"
        with Site(board(), toml) as site, Watcher(site) as watcher:
            for before, begun in ((b"", b""), (b"", b"GET"), (b"", whole[:-2]), (whole, b"GET / HT")):
                with socket.create_connection(("127.0.0.1", site.port), 10) as raw:
                    raw.sendall(before)
                    answer = b""
                    while before and not answer.endswith(b"</svg>\n"):
                        answer += raw.recv(4096)
                    raw.sendall(begun)
                    assert raw.recv(100) == b""
            for _ in range(5):
                watcher.take()  # its connection is no request that is late

    def test_huge_headers(self, site):
        for line in (b"GET /" + b"x" * 2_000_000, b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"x" * 2_000_000):
            with socket.create_connection(("127.0.0.1", site.port), 10) as raw:
                try:
                    raw.sendall(line)
                    answer = raw.recv(100)
                except OSError:
                    answer = b""  # cut off while we were still talking
            assert answer == b"" or answer.split()[1] in (b"400", b"431")
        assert ask(site, "/").status == 200


class TestToken:
    @pytest.mark.parametrize("path", ["/app.js", "/settings.toml", "/none", "/stream", "/index.html"])
    def test_nothing_without_it(self, locked, monkeypatch, path):
        monkeypatch.setattr(door, "AFTER_WRONG_TOKEN_S", 0.0)
        assert ask(locked, path).status == 401
        assert ask(locked, path, headers={"Authorization": f"Bearer {TOKEN}x"}).status == 401
        assert ask(locked, path, headers={"Cookie": f"lobula-{locked.port}={TOKEN}"}).status == 401

    def test_settings_neither(self, locked):
        assert ask(locked, "/settings", "POST", {"decision.collision_spikes": 9}).status == 401
        assert "collision_spikes = 4 " in ask(locked, "/settings.toml", headers=bearer()).text

    def test_the_stream_neither(self, locked):
        with pytest.raises(InvalidStatus, match="403"), Watcher(locked):
            pass
        with Watcher(locked, additional_headers=bearer()) as watcher:
            assert "hello" in watcher.take().head

    def test_the_header(self, locked):
        assert '<h1 id="name">' in ask(locked, "/", headers=bearer()).text

    def test_the_page_asks_for_it(self, locked):
        page = ask(locked, "/")
        assert page.status == 401
        assert 'action="/login"' in page.text
        assert ask(locked, "/style.css").status == 200

    def test_the_link_becomes_a_cookie(self, locked):
        assert locked.link == f"{locked.url}?token={TOKEN}"
        opened = ask(locked, f"/?token={TOKEN.replace(' ', '%20')}")
        assert opened.status == 200
        cookie = opened.headers["set-cookie"]
        assert cookie.startswith(f"lobula-{locked.port}=")
        assert {"httponly", "samesite=strict", "path=/"} <= {part.strip().lower() for part in cookie.split(";")}
        assert TOKEN not in cookie
        assert ask(locked, "/app.js", headers={"Cookie": cookie.split(";")[0]}).status == 200

    def test_the_form_becomes_a_cookie(self, locked):
        done = ask(locked, "/login", "POST", f"token={TOKEN.replace(' ', '+')}")
        assert (done.status, done.headers["location"]) == (303, "/")
        assert ask(locked, "/", headers={"Cookie": done.headers["set-cookie"].split(";")[0]}).status == 200

    @pytest.mark.parametrize("given", ["token=wrong", "", "token=%00%ff%zz"])
    def test_a_wrong_one_opens_nothing(self, locked, monkeypatch, given):
        monkeypatch.setattr(door, "AFTER_WRONG_TOKEN_S", 0.0)
        for answer in (ask(locked, "/login", "POST", given), ask(locked, f"/?token=x{given[:50]}")):
            assert answer.status == 401
            assert "set-cookie" not in answer.headers
            assert "That was not it." in answer.text

    def test_another_site_cannot_try(self, locked):
        assert ask(locked, "/login", "POST", f"token={TOKEN}", {"Origin": "http://evil.example"}).status == 403


class TestTheAddress:
    def test_a_port_that_is_taken(self, site):
        with pytest.raises(ParameterError, match=rf"--port {site.port}: taken: must be free, or 0 for any that is"):
            Site(board(), toml, port=site.port)

    def test_a_port_that_is_the_systems(self, monkeypatch):
        def refuse(*_):
            raise PermissionError(errno.EACCES, "Permission denied")

        monkeypatch.setattr(socket.socket, "bind", refuse)
        with pytest.raises(ParameterError, match="--port 80: not this user's to take: must be 1024 or above"):
            Site(board(), toml, port=80)

    def test_an_address_of_another_machine(self):
        with pytest.raises(ParameterError, match=r"--host 192.0.2.1, --port 0: must be an address of this machine"):
            Site(board(), toml, host="192.0.2.1")

    def test_a_name_that_is_none(self):
        with pytest.raises(ParameterError, match="must be an address or a name of this machine"):
            Site(board(), toml, host="no such name")

    def test_a_poor_token_leaves_the_port_free(self):
        with pytest.raises(ParameterError, match="must be at least 12"):
            Site(board(), toml, token="short")

    def test_away_from_loopback_a_token_is_made(self):
        with Site(board(), toml, host="0.0.0.0") as site:
            assert site.access.token is not None
            assert site.link.endswith(f":{site.port}/?token={site.access.token}")
            assert ask(site, "/app.js").status == 401
            assert ask(site, "/app.js", headers={"Authorization": f"Bearer {site.access.token}"}).status == 200

    def test_behind_a_proxy_on_the_same_machine_a_token_is_made(self):
        proxied = {"Host": "cam.example.org", "Origin": "https://cam.example.org"}
        with Site(board(), toml, also_known_as=["cam.example.org"]) as site:
            assert site.link == f"{site.url}?token={site.access.token}"
            for path in ("/app.js", "/settings.toml"):
                assert ask(site, path, headers=proxied).status == 401
            assert ask(site, "/settings", "POST", {"restore": True}, proxied).status == 401
            with pytest.raises(InvalidStatus, match="403"), Watcher(site, origin=f"http://127.0.0.1:{site.port}"):
                pass
            opened = ask(site, f"/?token={site.access.token}", headers=proxied)
            cookie = {"Cookie": opened.headers["set-cookie"].split(";")[0]}
            assert ask(site, "/settings", "POST", {"restore": True}, proxied | cookie).status == 200

    def test_it_ends_at_once_and_can_begin_again_there(self):
        with Site(board(), toml) as first:
            assert ask(first, "/").status == 200
        begun_s = time.monotonic()
        with Site(board(), toml, port=first.port) as again:
            assert ask(again, "/").status == 200
        assert time.monotonic() - begun_s < 10


def bearer():
    return {"Authorization": f"Bearer {TOKEN}"}
