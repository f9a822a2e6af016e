# SPDX-License-Identifier: MIT
"""Objects of the package around those of the compiled part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, Optional, Self, TypeVar

from beamgyro import _core, _html

Value = TypeVar("Value")


class Native(property, Generic[Value]):
    """A property that the compiled part of an object has, of this kind."""

    def __init__(self, kind: type[Value], words: str, name: str = "") -> None:
        def get(instance: Any) -> Any:
            return getattr(instance._native, self._name)
        get.__annotations__["return"] = kind
        super().__init__(get)
        self.__doc__ = words
        self._name = name

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = self._name or name

    if TYPE_CHECKING:
        def __get__(self, instance: Any, owner: Optional[type] = None
                    ) -> Value: ...


class Wrapper:
    """An object around one of the compiled part, which does not change."""

    __slots__ = ("_native",)

    _native: Any

    @classmethod
    def _of(cls, core: Any) -> Self:
        made = cls.__new__(cls)
        made._native = core
        return made

    @classmethod
    def _parsed(cls, *parts: Any) -> Self:
        """Return the object whose compiled part is made of these."""
        return cls._of(getattr(_core, cls.__name__).parse(*parts))

    def _rows(self) -> list[tuple[str, str]]:
        """Return what a notebook shows of the object, by name."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return _html.table((type(self).__name__.lower(), ""), self._rows())

    def _identity(self) -> Any:
        """Return what equal objects share."""
        raise NotImplementedError

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, type(self)):
            return NotImplemented
        return bool(self._identity() == other._identity())

    def __hash__(self) -> int:
        return hash(self._identity())
