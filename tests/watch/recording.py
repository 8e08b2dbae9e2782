# SPDX-License-Identifier: Apache-2.0
"""Cycles of a recording, read as docs/recording.md describes the format and not with Hotfire's own reader."""

import pathlib
import struct


def cycles(path):
    """Of each cycle: the nine numbers of its head, then commands and readings."""
    data = pathlib.Path(path).read_bytes()
    at = data.index(b"\ncycles\n") + len(b"\ncycles\n")
    header = [line.split(" ", 1) for line in data[:at].decode().splitlines()]
    actuators = int(dict(pair for pair in header if len(pair) == 2)["actuators"])
    readings = sum(1 for pair in header if pair[0] == "start")
    layout = struct.Struct(f"<Q5q3Q{actuators + readings}d")
    while data[at:at + 8] == b"HFBLOCK1":
        kind, count = struct.unpack_from("<II", data, at + 8)
        at += 32
        if kind == 1:
            return
        for _ in range(count):
            yield layout.unpack_from(data, at)
            at += layout.size
