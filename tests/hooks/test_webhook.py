"""Webhooks against a real HTTP server on loopback, encrypted too."""

from __future__ import annotations

import base64
import json
import shutil
import socket
import ssl
import subprocess
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest

from lobula.hooks import make_hook, webhook

from .listeners import LineServer, free_port
from .office import END, START, delivered, reading


@pytest.fixture
def server():
    """A server that notes requests; ``answers`` holds the next status codes, 204 when there are none."""

    class Handler(BaseHTTPRequestHandler):
        def do_POST(self):
            body = self.rfile.read(int(self.headers["Content-Length"]))
            self.server.requests.append((self.path, dict(self.headers), json.loads(body)))
            self.send_response(self.server.answers.pop(0) if self.server.answers else 204)
            self.send_header("Location", "http://127.0.0.1:1/elsewhere")
            self.end_headers()

        def log_message(self, *_):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.requests, server.answers = [], []
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    yield server
    server.shutdown()
    server.server_close()


def at(server, rest="/alarm", user="", scheme="http"):
    return f"{scheme}://{user}127.0.0.1:{server.server_port}{rest}"


def test_each_event_is_posted_as_json(server):
    tally = delivered(make_hook(at(server, "/a/b?key=k%20k")), START, END, readings=[reading(0.0)])
    assert [(path, body.pop("unix_s") > 0, body) for path, _, body in server.requests] == [
        ("/a/b?key=k%20k", True, START),
        ("/a/b?key=k%20k", True, END),
    ]
    headers = server.requests[0][1]
    assert headers["Content-Type"] == "application/json"
    assert headers["User-Agent"].startswith("lobula/")
    assert "Authorization" not in headers
    # the path of a webhook is often its password
    assert tally == {"hook": f"http://127.0.0.1:{server.server_port}", "sent": 2, "dropped": 0, "failures": 0}


def test_an_address_without_a_path(server):
    delivered(make_hook(at(server, "")), START)
    assert server.requests[0][0] == "/"


def test_letters_of_all_alphabets_in_a_path(server):
    tally = delivered(make_hook(at(server, "/räume/a%2Fb?wer=ö")), START)
    assert server.requests[0][0] == "/r%C3%A4ume/a%2Fb?wer=%C3%B6"
    assert tally["sent"] == 1


def test_user_and_password_are_sent_and_not_told(server):
    server.answers = [401]
    tally = delivered(make_hook(at(server, user="me:pa%40ss%2Fword@")), START)
    wanted = "Basic " + base64.b64encode(b"me:pa@ss/word").decode()
    assert server.requests[0][1]["Authorization"] == wanted
    assert tally["problem"] == "answered 401 Unauthorized"
    assert "word" not in str(tally)


@pytest.mark.parametrize(("status", "says"), [(404, "answered 404 Not Found"), (302, "answered 302 Found")])
def test_answers_that_another_try_would_not_change(server, status, says):
    server.answers = [status]
    tally = delivered(make_hook(at(server)), START, END)
    assert [body["phase"] for _, _, body in server.requests] == ["start", "end"]
    assert (tally["sent"], tally["dropped"], tally["problem"]) == (1, 1, says)


@pytest.mark.parametrize("status", [500, 503, 429])
def test_answers_that_ask_for_another_try(server, status):
    server.answers = [status]
    tally = delivered(make_hook(at(server)), START)
    assert [body["phase"] for _, _, body in server.requests] == ["start", "start"]
    assert (tally["sent"], tally["dropped"], tally["failures"]) == (1, 0, 1)


def test_nobody_there():
    assert delivered(make_hook(f"http://127.0.0.1:{free_port()}/x"), START)["problem"] == "Connection refused"


def test_a_server_that_never_answers(monkeypatch):
    monkeypatch.setattr(webhook, "TIMEOUT_S", 0.1)
    server = LineServer()
    assert delivered(make_hook(f"http://127.0.0.1:{server.at[1]}/x"), START)["problem"] == "timed out"
    server.close()


def test_a_server_of_another_kind():
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer():
            try:
                while True:
                    connection, _ = server.accept()
                    with connection:
                        connection.recv(4096)
                        connection.sendall(b"220 mail.example ESMTP\r\n")
            except OSError:
                pass

        threading.Thread(target=answer, daemon=True).start()
        problem = delivered(make_hook(f"http://127.0.0.1:{server.getsockname()[1]}/x"), START)["problem"]
        server.shutdown(socket.SHUT_RDWR)
    assert problem == "no answer in HTTP (BadStatusLine)"


@pytest.mark.skipif(shutil.which("openssl") is None, reason="needs openssl to make a certificate")
def test_an_encrypted_address_and_a_certificate_nobody_vouches_for(server, tmp_path, monkeypatch):
    certificate = make_certificate(tmp_path)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(certificate)
    server.socket = context.wrap_socket(server.socket, server_side=True)
    tally = delivered(make_hook(at(server, scheme="https")), START)
    assert (tally["sent"], "CERTIFICATE_VERIFY_FAILED" in tally["problem"]) == (0, True)
    monkeypatch.setenv("SSL_CERT_FILE", str(certificate))
    assert delivered(make_hook(at(server, scheme="https")), START)["sent"] == 1
    assert server.requests[0][2]["id"] == 1


def make_certificate(folder):
    """A key and a certificate of 127.0.0.1 that it signs itself, in one file."""
    path = folder / "own.pem"
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
         "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", path,
         "-out", folder / "certificate.pem"],
        check=True, capture_output=True,
    )  # fmt: skip
    path.write_text(path.read_text() + (folder / "certificate.pem").read_text())
    return path
