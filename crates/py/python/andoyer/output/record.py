"""The representation of a record as a call with the fields that differ from their defaults: signatures in `help` show ``Heading()``, not all its fields."""

from dataclasses import fields


class ShortRecord:
    """Base of dataclasses whose fields all have defaults."""

    def __repr__(self) -> str:
        given = [f"{field.name}={getattr(self, field.name)!r}" for field in fields(self) if getattr(self, field.name) != field.default]  # type: ignore[arg-type]
        return f"{type(self).__name__}({', '.join(given)})"
