"""The representation of a record as a call with the fields that differ from their defaults: signatures in `help` show ``Heading()``, not all its fields."""

from dataclasses import fields


class ShortRecord:
    """Base of dataclasses whose fields all have defaults."""

    def __repr__(self) -> str:
        default = type(self)()
        names = [field.name for field in fields(self)]  # type: ignore[arg-type]
        given = [f"{name}={getattr(self, name)!r}" for name in names if getattr(self, name) != getattr(default, name)]
        return f"{type(self).__name__}({', '.join(given)})"
