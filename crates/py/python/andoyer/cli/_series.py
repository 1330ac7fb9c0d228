"""`andoyer series`: the coefficients of the normal form."""

import argparse
import sys
from fractions import Fraction
from typing import Literal, get_args

import andoyer
from andoyer.cli._arguments import InputError, number, whole
from andoyer.cli._terminal import ProgressBar

LANGUAGES = ["c", "rust", "python"]
Part = Literal["hamiltonian", "generator", "direct", "inverse"]
PARTS: tuple[Part, ...] = get_args(Part)


def add_arguments(command: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    command.add_argument("--order", type=whole, required=True, metavar="N", help="order of the normal form")
    forms = ["text", "json", "latex", *LANGUAGES]
    command.add_argument("--to", choices=forms, default="text", metavar="FORM", help=f"output format: {', '.join(forms)} (default: text)")
    command.add_argument("--part", choices=PARTS, metavar="PART", help=f"part of the normal form for latex: {', '.join(PARTS)} (default: the first)")
    command.add_argument("--beta", type=number, metavar="BETA", help="triaxiality in source code (default: an argument of the function)")
    command.set_defaults(run=series)


def series(arguments: argparse.Namespace) -> int:
    """Print the normal form: its triaxiality polynomials, or all of it in another form."""
    for option, value, served in [("--part", arguments.part, ["latex"]), ("--beta", arguments.beta, LANGUAGES)]:
        if value is not None and arguments.to not in served:
            raise InputError(f"argument {option}: goes with --to {' or '.join(served)} alone, not with --to {arguments.to}")
    progress = ProgressBar("normal form, order")
    try:
        normal_form = andoyer.NormalForm(arguments.order, progress=progress if progress.visible else None)
    finally:
        progress.close()
    sys.stdout.write(as_text(normal_form, arguments))
    return 0


def as_text(normal_form: andoyer.NormalForm, arguments: argparse.Namespace) -> str:
    """The normal form as text in the requested format."""
    if arguments.to == "json":
        return normal_form.to_json() + "\n"
    if arguments.to == "latex":
        part: Part = arguments.part or PARTS[0]
        return normal_form.to_latex(part)
    if arguments.to in LANGUAGES:
        return normal_form.to_code(arguments.to, arguments.beta)
    lines = [f"P_{n} = {polynomial(normal_form.triaxiality_polynomial(n))}\n" for n in range(normal_form.order + 1)]
    return "".join(lines)


def polynomial(coefficients: dict[int, Fraction]) -> str:
    """A polynomial in beta as text that Python and SymPy read."""
    text = ""
    for power, coefficient in coefficients.items():
        sign = "-" if coefficient < 0 else "+"
        joint = f" {sign} " if text else sign.strip("+")
        text += joint + str(abs(coefficient)) + (f"*beta**{power}" if power else "")
    return text or "0"
