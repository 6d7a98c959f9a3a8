"""Cases: the input file of a simulation, its validation, and the shipped cases.

`schema` and `fields` define the keys, `reader` reads them, `build` and `elastic` make the problem
that is simulated; `limits`, `slips` and `doubts` check whether the theory applies and whether the
units are plausible.
"""
