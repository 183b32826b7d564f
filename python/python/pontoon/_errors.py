"""Exceptions: each has the stable code of its family, the place of the fault and the remedy."""

from __future__ import annotations

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

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (type(self), str(self), dict(self.__dict__)))


def _restored(kind: type[Error], text: str, fields: dict[str, Any]) -> Error:
    error = kind(text)
    error.__dict__.update(fields)
    return error


class SceneError(Error, ValueError):
    """The scene, or a file that it names, has invalid content."""


class UsageError(Error, ValueError):
    """A call asks for an object that does not exist, or cannot be carried out."""


def usage(what: str, help: str) -> UsageError:
    """Returns the exception for a call that cannot be carried out, with the remedy."""
    return UsageError(f"{what}\n  {help}", message=what, help=help)


class FileError(Error, OSError):
    """A file or folder cannot be read or written."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


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
