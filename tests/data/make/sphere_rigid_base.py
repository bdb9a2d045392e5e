"""Rigid paraboloid on a layer on a rigid base, under a given load: sphere_rigid_base.json."""

import sys

import sphere_coated
from common import main

NAME, SECONDS = "sphere_rigid_base.json", 2


def fill(content):
    sphere_coated.fill(content, rigid=True)


if __name__ == "__main__":
    main(sys.modules[__name__])
