"""Exceptions: each has the stable code of its family, the place of the fault and the remedy."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any


class Error(Exception):
    """Base of all exceptions of this package.

    Attributes:
        code: stable identifier of the family, as "unknown-key"; docs/reference/command-line.md lists them.
        message: one sentence that describes the fault.
        help: the remedy, or None.
        file, line, column, key: the place in a scene file, each None if it is not known.
    """

    def __init__(
        self,
        text: str = "",
        *,
        code: str = "invalid-usage",
        message: str | None = None,
        help: str | None = None,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        key: str | None = None,
        **details: Any,
    ) -> None:
        super().__init__(text)
        self.code = code
        self.message = text if message is None else message
        self.help = help
        self.file = file
        self.line = line
        self.column = column
        self.key = key
        self.__dict__.update(details)

    def __str__(self) -> str:
        # A KeyError would show its text in quotation marks, an OSError something else.
        return str(self.args[0]) if self.args else ""

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), str(self), dict(self.__dict__)))


def _restored(kind: type[Error], text: str, fields: dict[str, Any]) -> Error:
    error = kind(text)
    error.__dict__.update(fields)
    return error


class SceneError(Error, ValueError):
    """The scene, or a file that it names, has invalid content."""


class UsageError(Error, ValueError):
    """A call cannot be carried out."""


class UnknownNameError(UsageError, KeyError):
    """A call names a solid, joint, series, key or scene that does not exist; `help` has the nearest name."""


def usage(what: str, help: str) -> UsageError:
    """Returns the exception for a call that cannot be carried out, with the remedy."""
    return UsageError(f"{what}\n  {help}", message=what, help=help)


def unknown(what: str, name: str, known: Iterable[str], *, code: str = "unknown-name") -> UnknownNameError:
    """Returns the exception for `name`, which is none of `known`, with the nearest of them."""
    all_known = list(known)
    near = get_close_matches(name, all_known, n=3, cutoff=0.4)
    if near:
        help = f"did you mean {' or '.join(map(repr, near))}?"
    else:
        help = f"known: {', '.join(all_known)}" if all_known else "there is none"
    message = f"there is no {what} {name!r}"
    return UnknownNameError(f"{message}\n  {help}", code=code, message=message, help=help)


class FileError(Error, OSError):
    """A file or folder cannot be read or written."""


class RestartError(Error):
    """A checkpoint or a saved state is damaged, or belongs to another version or scene."""


class Fault(Error, ArithmeticError):
    """The computation left the valid range.

    Attributes:
        reason: the observation, as "speed above the speed of sound".
        who: the particle or body.
        step: number of steps completed before.
        time: simulated time, s.
        position, velocity: of the particle or body, m and m/s.
        density: of the particle, kg/m³, or None.
        cause: the usual cause and the remedy to try.
    """

    reason: str = ""
    who: str = ""
    step: int = 0
    time: float = 0.0
    position: list[float]
    velocity: list[float]
    density: float | None = None
    cause: str = ""
