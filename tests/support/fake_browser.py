#!/usr/bin/env python3
"""Stands for headless Chromium, for tests of films: a page whose worlds end at 2 s, and whose frames are a line
that says what was asked for. MODE in the environment is what goes wrong."""
import base64
import json
import os
import re
import sys
import time

mode = os.environ.get("MODE", "")
print("some library grumbles", flush=True)
if mode == "dies":
    sys.exit("no display")
if mode == "babbles":
    os.write(4, b"hello\0")
if mode == "sleeps":
    open("browser_waits", "w").write(str(os.getpid()))
    time.sleep(600)
data = b""


def say(message):
    os.write(4, json.dumps(message).encode() + b"\0")


folder = next(a for a in sys.argv if a.startswith("--user-data-dir="))[16:]
os.makedirs(folder)
open(folder + "/profile", "w").write("x")
frames = 0
while True:
    got = os.read(3, 65536)
    if not got:
        break
    data += got
    while b"\0" in data:
        text, data = data.split(b"\0", 1)
        asked = json.loads(text)
        method, parameters = asked["method"], asked["params"]
        result = {}
        if method == "Target.createTarget":
            result = {"targetId": "t"}
        if method == "Target.attachToTarget":
            result = {"sessionId": "s"}
        if method == "Emulation.setDeviceMetricsOverride":
            open("size", "w").write(f"{parameters['width']}x{parameters['height']}")
        if method == "Page.navigate":
            open("url", "w").write(parameters["url"])
            say({"method": "Page.loadEventFired", "params": {}, "sessionId": "s"})
        if method == "Runtime.evaluate":
            frame = re.match(r"manyworldsFilm.frame\((.*), '(.*)', (.*)\)$", parameters["expression"])
            value = 2
            if frame:
                frames += 1
                value = base64.b64encode(f"{frame[1]} {frame[2]} {frame[3]}\n".encode()).decode()
                if mode == "crashes" and frames == 3:
                    say({"method": "Inspector.targetCrashed", "params": {}, "sessionId": "s"})
                if mode == "crashes" and frames > 2:
                    continue
            result = {"result": {"value": value}}
            if mode == "refuses":
                result = {"result": {}, "exceptionDetails": {"text": "Uncaught", "exception": {
                    "description": "Error: there is no world 7, only 0 to 1\n    at f (page)"}}}
        if method == "Browser.close":
            sys.exit()
        say({"id": asked["id"], "result": result})
