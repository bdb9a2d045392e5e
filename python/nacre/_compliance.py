"""What `nacre.surface_compliance` returns."""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeVar

Value = TypeVar("Value")


class SurfaceCompliance(NamedTuple, Generic[Value]):
    """Surface compliances [m/Pa] of one wavenumber, or of an array of wavenumbers."""

    c11: Value
    """Normal displacement under pressure."""
    c12: Value
    """Lateral displacement under pressure, and normal displacement under lateral traction."""
    c22: Value
    """Displacement under traction along the wave."""
    ct: Value
    """Displacement under traction across the wave."""
