"""A building on bearings in motion, as one page for a browser that needs no network."""

from frames.viewer.page import write_view as write_view

__all__ = ["write_view"]
