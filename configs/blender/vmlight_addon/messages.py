# SPDX-License-Identifier: Apache-2.0
"""What vmlight's executables print: progress, warnings, errors, notes."""
import re
import textwrap

PROGRESS = re.compile(r"^(\S.*?)\s+(\d{1,3}) %\s+(.*)$")
MESSAGE = re.compile(r"^\w+ (WARNING|ERROR): (.*)$")


class Message:
    """@param kind: PROGRESS, WARNING, ERROR or INFO"""

    def __init__(self, kind, text, fraction=0.0):
        self.kind, self.text, self.fraction = kind, text, fraction

    def __repr__(self):
        return f"{self.kind} {self.text}"


def parse(line):
    """A line, without its end, as a Message; None where there is nothing in it."""
    line = line.strip()
    if not line:
        return None
    found = MESSAGE.match(line)
    if found:
        return Message(found.group(1), found.group(2))
    found = PROGRESS.match(line)
    if found and int(found.group(2)) <= 100:
        return Message("PROGRESS", f"{found.group(1)}: {' '.join(found.group(3).split())}", int(found.group(2)) / 100)
    return Message("INFO", line)


class Lines:
    """Cuts a stream into lines: a terminal's progress ends with a carriage return."""

    def __init__(self):
        self._rest = b""

    def feed(self, data):
        """The messages that end in `data`."""
        pieces = re.split(rb"[\r\n]+", self._rest + data)
        self._rest = pieces.pop()
        return self._parse(pieces)

    def end(self):
        """What has no end, when the stream has."""
        rest, self._rest = self._rest, b""
        return self._parse([rest])

    @staticmethod
    def _parse(pieces):
        parsed = (parse(piece.decode("utf-8", "replace")) for piece in pieces)
        return [message for message in parsed if message]


def wrapped(text, columns):
    """Lines of a panel that is `columns` wide; words that are longer, as paths are, are cut."""
    return textwrap.wrap(text, max(columns, 16), break_on_hyphens=False) or [""]
