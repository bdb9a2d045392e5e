"""Docstrings of attributes are text: a colon in their first line does not end a type.

Napoleon reads "Gap [m]: 0 in contact" as an attribute of the type "Gap [m]".
"""

from __future__ import annotations

from typing import Any

from sphinx.ext.napoleon import docstring


def setup(app: Any) -> dict[str, bool]:
    """Read docstrings of attributes whole."""

    def whole(self: Any) -> tuple[str, list[str]]:
        lines = self._dedent(self._consume_to_end())
        return "", self.__class__(lines, self._config).lines()

    docstring.NumpyDocstring._consume_inline_attribute = whole  # type: ignore[method-assign]
    return {"parallel_read_safe": True, "parallel_write_safe": True}
