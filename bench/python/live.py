#!/usr/bin/env python3
"""What it costs a batch to be viewed: steps per second alone, with a page served that nobody opened, and
with one that shows 64 worlds at 60 frames per second, in turns.

    PYTHONPATH=build/release/python bench/python/live.py --worlds 1024 --seconds 1 --repeats 7

The page is another process that asks for frames as a browser does and draws nothing. Time is the processor's,
of all threads of this process, the serving one included; what is printed are medians over rounds of the share
that each round loses. Frames come by the wall's clock, so a machine that is busy with other things makes the page dearer:
how many there were per second of this process stands beside it.
"""

import argparse
import json
import select
import socket
import statistics
import subprocess
import sys
import threading
import time

import manyworlds as mw


class Page:
    """A page without a browser."""

    def __init__(self, url, worlds, fps):
        host, path = url.removeprefix("http://").split("/", 1)
        name, port = host.split(":")
        self.socket = socket.create_connection((name, int(port)))
        self.socket.sendall(
            f"GET /{path}socket HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nConnection: Upgrade\r\n"
            "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode()
        )
        while not self._read(1) == b"\n" or self._read(2) != b"\r\n":
            pass
        self._send({"do": "open", "worlds": worlds})
        self._receive()
        self._send({"do": "show", "worlds": list(range(worlds)), "fps": fps})

    def frame(self):
        self._send({"do": "frame"})
        self._receive()

    def _read(self, size):
        out = bytearray()
        while len(out) < size:
            more = self.socket.recv(size - len(out))
            if not more:
                sys.exit(0)  # the other has ended
            out += more
        return bytes(out)

    def _send(self, message):
        data = json.dumps(message).encode()
        size = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + len(data).to_bytes(2, "big")
        self.socket.sendall(b"\x81" + size + bytes(4) + data)

    def _receive(self):
        size = self._read(2)[1]
        if size >= 126:
            size = int.from_bytes(self._read(2 if size == 126 else 8), "big")
        self._read(size)


def look_on(url, worlds, fps):
    """Asks for frames between the lines "on" and "off" on standard input; then says how many came."""
    page, on, frames = Page(url, worlds, fps), threading.Event(), 0
    done = threading.Event()

    def listen():
        for line in sys.stdin:
            if line == "on\n":
                on.set()
            else:
                done.clear()
                on.clear()
                done.wait()
                print(frames, flush=True)

    threading.Thread(target=listen, daemon=True).start()
    print("ready", flush=True)
    while True:
        done.set()
        on.wait()
        frames = 0
        while on.is_set():
            page.frame()
            frames += 1


def steps_per_second(batch, seconds):
    count, began = 0, time.process_time()
    while time.process_time() - began < seconds:
        batch.step()
        count += 1
    return count / (time.process_time() - began)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", default="bin-boxes")
    parser.add_argument("--worlds", type=int, default=1024)
    parser.add_argument("--shown", type=int, default=64)
    parser.add_argument("--fps", type=int, default=60)
    parser.add_argument("--seconds", type=float, default=1, help="of the processor, for each turn")
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--page", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.page:
        return look_on(options.page, options.shown, options.fps)

    # A batch for each, so that all have taken as many turns.
    alone, unseen, seen = batches = [mw.Batch(options.scene, worlds=options.worlds) for _ in range(3)]
    views = [mw.view(batch, worlds=options.shown) for batch in (unseen, seen)]
    command = [sys.executable, __file__, "--page", views[1].url]
    command += ["--shown", str(options.shown), "--fps", str(options.fps)]
    page = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert page.stdout.readline() == "ready\n"

    def tell(word):
        page.stdin.write(word + "\n")
        page.stdin.flush()

    def turn(batch):
        if batch is not seen:
            return steps_per_second(batch, options.seconds)
        tell("on")
        speed = steps_per_second(batch, options.seconds)
        tell("off")
        while not select.select([page.stdout], [], [], 0)[0]:
            batch.step()  # for the frame that it may be waiting for
        frames.append(int(page.stdout.readline()) / options.seconds)
        return speed

    frames, lost = [], {"nobody looking": [], "one page": []}
    for batch in batches:
        steps_per_second(batch, options.seconds)  # warm, and at rest
    for n in range(options.repeats):
        order = [*batches[n % 3 :], *batches[: n % 3]]
        speeds = {id(batch): turn(batch) for batch in order}
        for what, batch in zip(lost, (unseen, seen)):
            lost[what].append(1 - speeds[id(batch)] / speeds[id(alone)])
    page.kill()
    for view in views:
        view.close()
    speed = speeds[id(alone)]
    print(f"{options.scene}, {options.worlds} worlds, {alone.threads} threads, {speed:.0f} steps/s of the processor's time")
    for what, shares in lost.items():
        ends = f"{100 * min(shares):+.1f} to {100 * max(shares):+.1f}"
        print(f"  {what:15} {100 * statistics.median(shares):+.1f} %  ({ends})")
    print(f"  {statistics.median(frames):.0f} frames of {options.shown} worlds per second of the processor's time")


if __name__ == "__main__":
    main()
