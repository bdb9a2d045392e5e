"""Measured surfaces and profiles from files, and from SurfaceTopography."""

from nacre.surfaces.maps import read_map
from nacre.surfaces.profiles import read_profile

__all__ = ["read_map", "read_profile"]
__dir__ = __all__.copy
