"""Case files of indentations: `nacre.case.Case`, under the name that earlier versions had."""

from importlib import import_module

Case = import_module("nacre.case").Case  # `nacre.case` stands on this package

__all__ = ["Case"]
