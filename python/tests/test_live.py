"""Live pages from Python; what is on them is tested in C++ and in a browser."""

import base64
import json
import os
import socket
import struct
import threading

import numpy as np
import pytest

import manyworlds as mw

pytest.importorskip("manyworlds._live")

EMPTY = (
    '<meta name="manyworlds-page" content="1"><meta content="connect-src blob:">'
    "<!-- manyworlds: recordings -->"
)


@pytest.fixture(autouse=True)
def viewer(tmp_path, monkeypatch):
    file = tmp_path / "viewer.html"
    file.write_text(EMPTY)
    monkeypatch.setenv("MANYWORLDS_VIEWER", str(file))


class Page:
    """A page without a browser."""

    def __init__(self, view):
        host = f"127.0.0.1:{view.port}"
        self.socket = socket.create_connection(("127.0.0.1", view.port), timeout=30)
        path = view.url.removeprefix(f"http://{host}")
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET {path}socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nConnection: Upgrade\r\n"
            f"Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n".encode()
        )
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self.read(1)
        assert b" 101 " in head

    def read(self, size):
        out = b""
        while len(out) < size:
            more = self.socket.recv(size - len(out))
            if not more:
                raise EOFError
            out += more
        return out

    def send(self, **message):
        data = json.dumps(message).encode()
        assert len(data) < 65536
        size = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack(">H", len(data))
        self.socket.sendall(b"\x81" + size + bytes(4) + data)

    def receive(self):
        first, size = self.read(2)
        if size >= 126:
            size = int.from_bytes(self.read(2 if size == 126 else 8), "big")
        data = self.read(size)
        return json.loads(data) if first == 0x81 else data if first == 0x82 else self.receive()

    def receive_while(self, step):
        """What comes while another thread steps, as the program's would."""
        got = []
        thread = threading.Thread(target=lambda: got.append(self.receive()))
        thread.start()
        while thread.is_alive():
            step()
        return got[0]


def positions(frame, planar=False):
    worlds, bodies = struct.unpack_from("<II", frame, 44)
    width = 2 if planar else 3
    return np.frombuffer(frame, "<f4", width * bodies, 64 + 8 * worlds).reshape(worlds, -1, width)


def test_a_page_sees_a_batch_and_drags_it():
    batch = mw.Batch("free-flight", worlds=3)
    with mw.view(batch, worlds=2) as view:
        assert view.url == batch._views[0].url and f":{view.port}/" in view.url
        page = Page(view)
        page.send(do="open", worlds=2)
        head = page.receive()["head"]
        assert head["all_worlds"] == 3 and head["can"]["clock"] is False
        page.send(do="frame")
        assert np.allclose(positions(page.receive()), batch.get("position")[:2], atol=1e-5)
        body = int(batch.plan.scene.bodies[0].motion == "fixed")
        to = (batch.get("position")[1, 0] + [1, 0, 0]).tolist()
        page.send(do="drag", world=1, body=body, at=[0, 0, 0], to=to)
        page.send(do="frame")
        assert struct.unpack_from("<d", page.receive_while(batch.step), 16)[0] > 0
        batch.step(200)
        for _ in range(200):
            batch.step()
        assert np.allclose(batch.get("position")[1, 0], to, atol=0.05)
        page.send(do="reset")
        assert "does not allow pages" in page.receive_while(batch.step)["said"]
    assert view.url == "" and not batch._views
    view.close()
    with pytest.raises((EOFError, OSError)):
        page.receive()


def test_looking_on_changes_no_bit():
    alone, watched = mw.Batch("stack10", worlds=5), mw.Batch("stack10", worlds=5)
    view = mw.view(watched)
    for batch in (alone, watched):
        batch.step(30)
        batch.reset([1, 3])
        batch.step_to(batch.time + 0.2)
    assert alone.hash() == watched.hash()
    watched.close()
    assert view.url == ""


def test_an_environment_is_looked_at():
    environment = mw.Environment("LunarLander", worlds=2)
    with mw.view(environment) as view:
        page = Page(view)
        page.send(do="open", worlds=1)
        assert page.receive()["head"]["space"] == "planar"
        page.send(do="frame")
        page.receive()
        page.send(do="frame")
        actions = np.zeros(environment.action_shape, np.int64)
        frame = page.receive_while(lambda: environment.step(actions))
        assert np.isfinite(positions(frame, planar=True)).all()


def test_gymnasiums_environments_have_a_view():
    pytest.importorskip("gymnasium")
    from manyworlds.gym import VectorEnv

    envs = VectorEnv("LunarLander", 2)
    with envs.unwrapped.view(title="Landers") as view:
        page = Page(view)
        page.send(do="open", worlds=2)
        assert page.receive()["head"]["title"] == "Landers"
    envs.close()


def test_what_cannot_be_viewed_says_why(tmp_path, monkeypatch):
    batch = mw.Batch("ball3d")
    with pytest.raises(TypeError, match="expected a Batch or an Environment"):
        mw.view("ball3d")
    with pytest.raises(ValueError, match="port is 70000"):
        mw.view(batch, port=70000)
    with mw.view(batch) as view, pytest.raises(ValueError, match=f"port {view.port} of 127.0.0.1"):
        mw.view(batch, port=view.port)
    monkeypatch.setenv("MANYWORLDS_VIEWER", str(tmp_path / "none.html"))
    with pytest.raises(FileNotFoundError, match="none.html"):
        mw.view(batch)
