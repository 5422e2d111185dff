"""Whole-number constants of a C header, worked out as a compiler does; so that what C adds up is written down once."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable
from typing import Any

DEFINE = re.compile(r"^#define[ \t]+(\w+)(?:\(([\w, ]*)\))?[ \t]+(.+)$", re.MULTILINE)
TOKEN = re.compile(r"[0-9][0-9.]*(?:e[-+]?[0-9]+)?|\w+|\|\||&&|[<>=!]=|[-+*/<>?:(),!]")
LEVELS: tuple[dict[str, Callable[[Any, Any], Any]], ...] = (
    {"||": lambda a, b: bool(a) or bool(b)},
    {"&&": lambda a, b: bool(a) and bool(b)},
    {"==": operator.eq, "!=": operator.ne},
    {"<": operator.lt, ">": operator.gt, "<=": operator.le, ">=": operator.ge},
    {"+": operator.add, "-": operator.sub},
    {"*": operator.mul, "/": operator.floordiv},
)
"""Operators between two values, those that bind least first; nothing here is negative, so / rounds as in C."""

Macros = dict[str, tuple[list[str], str]]


def constant(name: str, text: str) -> int:
    """Return what the macro ``name`` stands for in the C ``text``, which defines all that it uses."""
    plain = re.sub(r"/\*.*?\*/", " ", text.replace("\\\n", " "), flags=re.DOTALL)
    macros = {found[1]: ((found[2] or "").replace(",", " ").split(), found[3]) for found in DEFINE.finditer(plain)}
    return int(_Expression(macros, macros[name][1], {}).value())


class _Expression:
    """A C expression over numbers and macros; ``known`` holds the arguments of the macro that it is the body of."""

    def __init__(self, macros: Macros, text: str, known: dict[str, Any]) -> None:
        self._macros, self._known = macros, known
        self._tokens: list[str] = [*TOKEN.findall(re.sub(r"(?<=[0-9.])f\b", "", text)), ""]
        self._at = 0

    def value(self) -> Any:
        condition = self._joined(0)
        if self._next != "?":
            return condition
        self._take()
        yes = self.value()
        self._take()  # the colon
        no = self.value()
        return yes if condition else no

    @property
    def _next(self) -> str:
        return self._tokens[self._at]

    def _take(self) -> str:
        self._at += 1
        return self._tokens[self._at - 1]

    def _joined(self, level: int) -> Any:
        if level == len(LEVELS):
            return self._single()
        value = self._joined(level + 1)
        while self._next in LEVELS[level]:
            value = LEVELS[level][self._take()](value, self._joined(level + 1))
        return value

    def _single(self) -> Any:
        token = self._take()
        if token == "!":
            return not self._single()
        if token == "(":
            if self._next == "int":
                self._at += 2
                return int(self._single())
            value = self.value()
            self._take()
            return value
        if token[0].isdigit():
            return int(token) if token.isdigit() else float(token)
        return self._known[token] if token in self._known else self._macro(token)

    def _macro(self, name: str) -> Any:
        names, body = self._macros[name]
        given = {}
        for argument in names:
            self._take()  # the bracket, or a comma
            given[argument] = self.value()
        if names:
            self._take()
        return _Expression(self._macros, body, given).value()
