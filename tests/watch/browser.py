# SPDX-License-Identifier: Apache-2.0
"""Pages in headless Chromium, in real time: asks them by the DevTools protocol, with the standard library alone."""

import base64
import json
import os
import pathlib
import shutil
import socket
import struct
import subprocess
import tempfile
import time
import urllib.parse
import urllib.request


def find():
    """The browser, or None."""
    names = ("chromium", "chromium-browser", "google-chrome")
    return next((path for path in map(shutil.which, names) if path), None)


class Socket:
    """A WebSocket of texts. [RFC 6455]"""

    def __init__(self, url):
        parts = urllib.parse.urlsplit(url)
        self.stream = socket.create_connection((parts.hostname, parts.port), timeout=60)
        key = base64.b64encode(os.urandom(16)).decode()
        self.stream.sendall(
            f"GET {parts.path} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        head = b""
        while not head.endswith(b"\r\n\r\n"):
            head += self.receive(1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise ConnectionError(head.decode())

    def receive(self, count):
        data = b""
        while len(data) < count:
            more = self.stream.recv(count - len(data))
            if not more:
                raise ConnectionError("the browser has closed the connection")
            data += more
        return data

    def send(self, text):
        data = text.encode()
        mask = os.urandom(4)
        size = struct.pack("!BBH", 0x81, 0xFE, len(data)) if len(data) < 65536 else struct.pack("!BBQ", 0x81, 0xFF, len(data))
        self.stream.sendall(size + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)))

    def read(self):
        text = b""
        while True:
            first, size = self.receive(2)
            if size == 126:
                size = struct.unpack("!H", self.receive(2))[0]
            elif size == 127:
                size = struct.unpack("!Q", self.receive(8))[0]
            part = self.receive(size)
            if first & 0x0F in (0, 1):
                text += part
                if first & 0x80:
                    return text.decode()


class Page:
    """One page."""

    def __init__(self, address):
        self.socket = Socket(address)
        self.number = 0

    def call(self, method, **parameters):
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self.socket.read())
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]

    def value(self, expression):
        """What an expression of the page gives."""
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']['exception']['description']}")
        return result["result"].get("value")

    def wait(self, expression, seconds=15.0):
        """Asks until the expression is true; its value, or that of the last time."""
        until = time.monotonic() + seconds
        while True:
            value = self.value(expression)
            if value or time.monotonic() > until:
                return value
            time.sleep(0.05)

    def screenshot(self, path):
        pathlib.Path(path).write_bytes(base64.b64decode(self.call("Page.captureScreenshot")["data"]))


class Browser:
    """A browser of its own, with nothing of the user's."""

    def __init__(self, size="1280,1000"):
        self.folder = tempfile.mkdtemp()
        self.log = open(os.path.join(self.folder, "log"), "wb")
        self.process = subprocess.Popen(
            [find(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage",
             "--enable-precise-memory-info", f"--user-data-dir={self.folder}/profile", "--remote-debugging-port=0",
             f"--window-size={size}", "about:blank"],
            stdout=self.log, stderr=subprocess.STDOUT)
        port_file = pathlib.Path(self.folder, "profile", "DevToolsActivePort")
        until = time.monotonic() + 60
        while not (port_file.exists() and port_file.read_text().strip()):
            if time.monotonic() > until or self.process.poll() is not None:
                raise RuntimeError("the browser does not start: " + pathlib.Path(self.folder, "log").read_text())
            time.sleep(0.1)
        self.port = int(port_file.read_text().split()[0])

    def open(self, url):
        """A page in a window of its own."""
        where = f"http://127.0.0.1:{self.port}/json/new?{urllib.parse.quote(url, safe=':/#=&;')}"
        with urllib.request.urlopen(urllib.request.Request(where, method="PUT"), timeout=60) as answer:
            page = Page(json.load(answer)["webSocketDebuggerUrl"])
        page.wait("location.href !== 'about:blank' && document.readyState === 'complete'")
        return page

    def close(self):
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)
