"""The package `frames.design` called as the function of that name in the version before."""

from __future__ import annotations

import sys
import warnings
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable


class _CallablePackage(ModuleType):
    """A package that can be called, with a warning that names the function."""

    def __call__(self, *args: Any, **options: Any) -> Any:
        """Return what the function returns."""
        warnings.warn(
            f"the function {self.__name__} is now {self.__name__}.design; the old name goes with "
            "version 0.3",
            DeprecationWarning,
            stacklevel=2,
        )
        return self._called(*args, **options)


def make_callable(package: str, function: Callable[..., Any]) -> None:
    """Let a package be called as a function."""
    module = sys.modules[package]
    module._called = function  # type: ignore[attr-defined]
    module.__class__ = _CallablePackage
