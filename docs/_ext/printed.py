"""Printed equations as LaTeX: the lines of the blocks marked `equation`, which the tests execute.

A line is ``name = expression``, optionally after ``printed`` or ``correct``. Products keep their order; numbers and i are in front as one fraction.
"""

import re

GREEK = {"alpha", "beta", "gamma", "kappa", "omega", "sigma", "tau"}
WORDS = ("printed", "correct")
TOKEN = re.compile(r"\s*(\d+|[A-Za-z]+(?:_\d+)?|.)")


class Reader:
    """Recursive descent over one expression."""

    def __init__(self, text: str) -> None:
        self.tokens = [token for token in TOKEN.findall(text) if token.strip()]

    def next_is(self, *tokens: str) -> bool:
        return bool(self.tokens) and self.tokens[0] in tokens

    def expression(self) -> str:
        text = ""
        while True:
            sign = self.tokens.pop(0) if self.next_is("+", "-") else ""
            term = self.term()
            text += (f" {sign} " if text else sign.strip("+")) + term
            if not self.next_is("+", "-"):
                return text

    def term(self) -> str:
        above, below = [self.power()], []
        while self.next_is("*", "/"):
            (above if self.tokens.pop(0) == "*" else below).append(self.power())
        bare = [factor.removeprefix("(").removesuffix(")") for factor in below]
        scalar = [factor for factor in above if factor.isdigit() or factor == "i"]
        rest = [factor for factor in above if factor not in scalar]
        if not all(factor.isdigit() for factor in below):
            return rf"\frac{{{product(above)}}}{{{product(bare)}}}"
        if not below:
            return product(above)
        return rf"\frac{{{product(scalar) or '1'}}}{{{product(bare)}}}\,{product(rest)}"

    def power(self) -> str:
        base = self.atom()
        if self.next_is("^"):
            self.tokens.pop(0)
            return f"{base}^{{{self.atom()}}}"
        return base

    def atom(self) -> str:
        token = self.tokens.pop(0)
        if token == "(":
            inner = self.expression()
            if not self.next_is(")"):
                raise ValueError(f"a bracket is open before {self.tokens}")
            self.tokens.pop(0)
            return f"({inner})"
        if token.isdigit() or token == "i":
            return token
        if token.isidentifier():
            return symbol(token)
        raise ValueError(f"{token!r} is no part of an expression")


def product(factors: list[str]) -> str:
    """A product of factors. Between two numbers there is a dot."""
    text = ""
    for factor in factors:
        if factor == "1" and len(factors) > 1:
            continue
        text += (r" \cdot " if text and factor[0].isdigit() else " " if text else "") + factor
    return text


def symbol(name: str) -> str:
    """A name as LaTeX."""
    head, _, index = name.partition("_")
    if head in GREEK:
        head = f"\\{head}"
    elif head == "Z":
        head = r"\bar z"
    elif len(head) > 1:
        head = rf"\text{{{head}}}"
    return f"{head}_{{{index}}}" if index else head


def latex(line: str) -> str:
    """One line as LaTeX with an alignment mark."""
    word, _, rest = line.partition(" ")
    said = rf"\text{{{word}:}}\quad " if word in WORDS else ""
    name, equals, expression = (rest if said else line).partition("=")
    if not equals:
        raise ValueError(f"{line!r} is no equation")
    reader = Reader(expression)
    text = reader.expression()
    if reader.tokens:
        raise ValueError(f"{line!r} goes on after its end: {reader.tokens}")
    return f"{said}{symbol(name.strip())} &= {text}"


def display(lines: list[str]) -> str:
    """The lines of a block, one below the other."""
    rows = r" \\ ".join(latex(line) for line in lines if line.strip())
    return rf"\begin{{align*}} {rows} \end{{align*}}"
