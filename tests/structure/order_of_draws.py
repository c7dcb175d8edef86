"""Draws of random numbers whose order the compiler may choose: two in the arguments of one call, or in one sum or product.
clang and g++ choose differently, so that the same seed gives other samples. Between braces, from statement to statement and
between declarators the order is fixed."""

from __future__ import annotations

import re

HANDED_ON = re.compile(r"\w+\((?:\w+, )?random\b(?!\.)")  # to a function, whose arguments are drawn before it begins
DRAW = re.compile(r"\brandom\.\w+\(|\buniform_number\(|\bDRAW\b")
SEPARATORS = ",;"


def without_comments(text: str) -> str:
    """Comments and strings as blanks of the same length."""
    return re.sub(r'//[^\n]*|"(?:\\.|[^"\\\n])*"', lambda found: " " * len(found[0]), text)


def pieces(text: str, start: int, end: int) -> list[str]:
    """What stands between separators, with what is between braces left out."""
    result, depth, braces, piece = [], 0, 0, ""
    for character in text[start:end]:
        depth += character in "([" and not braces
        depth -= character in ")]" and not braces
        braces += character == "{"
        braces -= character == "}"
        if character in SEPARATORS and not depth and not braces:
            result.append(piece)
            piece = ""
        elif not braces:
            piece += character
    return [*result, piece]


def closing(text: str, start: int) -> int:
    """Where the parenthesis that opens before `start` closes."""
    depth = 1
    for at in range(start, len(text)):
        depth += text[at] == "("
        depth -= text[at] == ")"
        if depth == 0:
            return at
    return len(text)


def draws(piece: str) -> int:
    while call := HANDED_ON.search(piece):
        piece = piece[:call.start()] + "DRAW" + piece[closing(piece, piece.index("(", call.start()) + 1):]
    return len(DRAW.findall(piece))


def disordered_lines(source: str) -> list[int]:
    """Numbers of the lines on which calls begin whose arguments draw more than once."""
    text, lines = without_comments(source), set()
    for call in re.finditer(r"\w\(|\breturn ", text):
        start = call.end()
        end = closing(text, start) if call[0].endswith("(") else text.find(";", start)
        if sum(draws(piece) for piece in pieces(text, start, end)) > 1:
            lines.add(text.count("\n", 0, call.start()) + 1)
    return sorted(lines)
