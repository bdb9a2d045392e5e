"""nacre compared with other contact solvers: equal problems, equal residuals, one run.

``make peers`` runs it; ``benches/README.md`` describes the measurement.

=============  ===================================================================
`install`      a virtual environment with nacre's wheel and the other programs
`problems`     the problems that are solved
`programs`     the programs, each called through its Python interface
`judge`        the residual of any pressure, by nacre's coefficients
`worker`       one measurement, in a separate process
`measure`      starts workers; finds the tolerance for the required residual
`figures`      ratios and other figures of nacre itself
`report`       CSV, Markdown and plot
=============  ===================================================================
"""
