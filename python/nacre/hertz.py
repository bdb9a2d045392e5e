"""Closed forms for the contact of curved bodies, after Hertz.

They hold for smooth homogeneous bodies, on a contact that is small compared with their radii.
"""

from nacre._core import Ellipse, Line, Point, contact_modulus, equivalent_radius

__all__ = ["Ellipse", "Line", "Point", "contact_modulus", "equivalent_radius"]
