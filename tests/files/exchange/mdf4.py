# SPDX-License-Identifier: Apache-2.0
"""MDF 4.1 files, read and written as the standard describes them and not with Hotfire's own code.

Source: ASAM MCD-2 MDF, version 4.1.1: identification block and blocks HD, FH, DG, CG, CN, CC, TX, MD, DT, DL, DZ."""

import struct
import xml.etree.ElementTree as xml
import zlib

# Data section of each block with a fixed one, and its number of links.
LAYOUTS = {
    "HD": ("QhhBBBxdd", 6), "FH": ("QhhB3x", 2), "DG": ("B7x", 4), "CG": ("QQHH4xII", 6), "CN": ("BBBBIIIIBxH6d", 8),
    "TX": (None, 0), "MD": (None, 0), "DT": (None, 0),
}
# The blocks that a link may lead to; a link to nowhere is 0.
LINKS = {
    "HD": [("DG",), ("FH",), ("CH",), ("AT",), ("EV",), ("MD", "TX")],
    "FH": [("FH",), ("MD",)],
    "DG": [("DG",), ("CG",), ("DT", "DZ", "DL", "HL"), ("MD", "TX")],
    "CG": [("CG",), ("CN",), ("TX",), ("SI",), ("SR",), ("MD", "TX")],
    "CN": [("CN",), ("CN", "CA"), ("TX",), ("SI",), ("CC",), ("SD", "DZ", "DL", "HL", "CG"), ("TX", "MD"), ("TX", "MD")],
}


class Damage(Exception):
    """What the standard does not allow."""


def require(what, holds):
    if not holds:
        raise Damage(what)


class Strict:
    """A file that has to keep to the standard in every byte. `channels`: {name: (unit, [values])} of its only group."""

    def __init__(self, data):
        self.data = data
        require("the identification is that of a finalised file", data[:8] == b"MDF     ")
        require("the version is written with blanks", data[8:16] == b"4.10    ")
        require("the program has a name", data[16:24].strip())
        version, = struct.unpack_from("<H", data, 28)
        require("the version is a number too", version == 410)
        require("what is reserved is zero, and nothing is undone", not any(data[24:28]) and not any(data[30:64]))
        self.blocks = {}
        at = 64
        while at < len(data):
            at = self.add_block(at)
        require("the last block ends with the file", at == len(data))
        self.check_links()
        self.channels = self.read()

    def add_block(self, at):
        mark, reserved, length, links = struct.unpack_from("<4sIQQ", self.data, at)
        name = mark[2:].decode("ascii")
        require(f"a block begins at {at}, at a multiple of 8", at % 8 == 0 and mark[:2] == b"##" and reserved == 0)
        require(f"the block {name} is known", name in LAYOUTS)
        layout, wanted = LAYOUTS[name]
        require(f"{name} has {wanted} links", links == wanted)
        begin = at + 24 + 8 * links
        body = self.data[begin:at + length]
        require(f"{name} lies in the file", at + length <= len(self.data) and len(body) == length - 24 - 8 * links)
        if layout:
            require(f"{name} has its length", len(body) == struct.calcsize("<" + layout))
        self.blocks[at] = (name, struct.unpack_from(f"<{links}Q", self.data, at + 24), body)
        end = at + length + -length % 8
        require(f"{name} is filled up with zeros", not any(self.data[at + length:end]))
        return end

    def check_links(self):
        reached = {64}
        for name, links, _ in self.blocks.values():
            for number, target in enumerate(links):
                if target:
                    require(f"link {number} of {name} leads to a block", target in self.blocks)
                    require(f"link {number} of {name} leads to one of {LINKS[name][number]}",
                            self.blocks[target][0] in LINKS[name][number])
                    reached.add(target)
        require("every block is reached", reached == set(self.blocks))

    def block(self, at, name):
        require(f"{name} is at {at}", self.blocks[at][0] == name)
        _, links, body = self.blocks[at]
        layout = LAYOUTS[name][0]
        return links, struct.unpack("<" + layout, body) if layout else body

    def text(self, at):
        _, body = self.block(at, self.blocks[at][0])
        require("a text ends with a zero", body.endswith(b"\0"))
        return body[:body.index(b"\0")].decode("utf-8")

    def read(self):
        links, _ = self.block(64, "HD")
        history, _ = self.block(links[1], "FH")
        comment = xml.fromstring(self.text(history[1]))
        require("the history names the program", comment.tag == "FHcomment" and all(
            comment.findtext(each) for each in ("tool_id", "tool_vendor", "tool_version")))
        (next_group, group, data, _), (id_bytes,) = self.block(links[0], "DG")
        require("there is one group, sorted", next_group == 0 and id_bytes == 0)
        (next_cg, channel, _, *_), (record_id, cycles, flags, _, row_bytes, invalid_bytes) = self.block(group, "CG")
        require("the group is alone", next_cg == 0 and record_id == 0 and flags == 0 and invalid_bytes == 0)
        _, rows = self.block(data, "DT")
        require("the rows are all there", len(rows) == cycles * row_bytes)
        channels, used, masters = {}, [], 0
        while channel:
            own, fields = self.block(channel, "CN")
            kind, sync, data_type, bit, byte, bits, flags, _, _, attachments, *_ = fields
            require("a channel is a double of its row", (data_type, bit, bits, flags, attachments) == (4, 0, 64, 0, 0))
            require("a master is a time, and nothing else is", (kind, sync) in ((2, 1), (0, 0)))
            masters += kind == 2
            used.append((byte, byte + 8))
            values = [struct.unpack_from("<d", rows, row * row_bytes + byte)[0] for row in range(cycles)]
            name = self.text(own[2])
            require(f"the channel {name} is there once", name and name not in channels)
            channels[name] = (self.text(own[6]), values)
            channel = own[0]
        require("there is one master, and it comes first", masters == 1 and next(iter(channels)) == "time")
        used.sort()
        require("channels fill the row and do not overlap",
                used == [(8 * i, 8 * i + 8) for i in range(len(used))] and row_bytes == 8 * len(used))
        return channels


class Writer:
    """A file as loggers write it: rows of two groups in one list of data blocks ("unsorted"), integers with a conversion,
    invalidation bits, some blocks compressed."""

    def __init__(self):
        self.data = bytearray(64 + 104)

    def add(self, name, links=(), body=b""):
        self.data += bytes(-len(self.data) % 8)
        at = len(self.data)
        self.data += struct.pack("<4sIQQ", b"##" + name.encode(), 0, 24 + 8 * len(links) + len(body), len(links))
        self.data += struct.pack(f"<{len(links)}Q", *links) + body
        return at

    def text(self, text):
        return self.add("TX", (), text.encode() + b"\0")

    def channel(self, following, name, unit, fields, conversion=0):
        """fields: type, sync, data type, byte, bits, flags, invalidation bit."""
        kind, sync, data_type, byte, bits, flags, invalid = fields
        return self.add("CN", (following, 0, self.text(name), 0, conversion, 0, self.text(unit), 0),
                        struct.pack("<BBBBIIIIBxH6d", kind, sync, data_type, 0, byte, bits, flags, invalid, 0, 0, *[0.0] * 6))

    def linear(self, offset, factor):
        return self.add("CC", (0, 0, 0, 0), struct.pack("<BBHHHdddd", 1, 0, 0, 0, 2, 0.0, 0.0, offset, factor))

    def group(self, following, channel, name, numbers):
        """numbers: record id, rows, flags, bytes of a row, bytes of its invalidation bits."""
        record_id, rows, flags, row_bytes, invalid_bytes = numbers
        return self.add("CG", (following, channel, self.text(name), 0, 0, 0),
                        struct.pack("<QQHH4xII", record_id, rows, flags, 0, row_bytes, invalid_bytes))

    def list_of(self, pieces):
        """A list of data blocks, every other one compressed."""
        places = []
        for number, piece in enumerate(pieces):
            if number % 2:
                small = zlib.compress(piece)
                places.append(self.add("DZ", (), struct.pack("<2sBxIQQ", b"DT", 0, 0, len(piece), len(small)) + small))
            else:
                places.append(self.add("DT", (), piece))
        offsets = [sum(map(len, pieces[:number])) for number in range(len(pieces))]
        return self.add("DL", (0, *places), struct.pack(f"<B3xI{len(offsets)}Q", 0, len(offsets), *offsets))

    def finish(self, data_group, undone=0):
        history = self.add("FH", (0, self.add("MD", (), b"<FHcomment><TX/><tool_id>logger</tool_id></FHcomment>\0")), bytes(16))
        self.data[:64] = struct.pack("<8s8s8s4xH30xHH", b"UnFinMF " if undone else b"MDF     ", b"4.10    ", b"logger  ", 410,
                                     undone, 0)
        self.data[64:168] = struct.pack("<4sIQQ6Q32x", b"##HD", 0, 104, 6, data_group, history, 0, 0, 0, 0)
        return bytes(self.data)
