"""nacre beside other contact solvers: the same problems, to the same residual, in one run.

``make peers`` runs it; ``benches/README.md`` says what is measured and how.

=============  ===================================================================
`install`      a virtual environment with nacre's wheel and the other programs
`problems`     what is solved
`programs`     who solves it, each through its own interface
`judge`        the residual of anybody's pressure, by nacre's coefficients
`worker`       one measurement, in a process of its own
`measure`      starts workers; finds the tolerance that gives the residual asked
`figures`      the figures that have a bar
`report`       CSV, Markdown and plot
=============  ===================================================================
"""
