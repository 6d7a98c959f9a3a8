"""Cases: the input file of a simulation, its validation, and the shipped cases.

`sections` and `fields` define the keys, `reader` reads them, `build`, `rigid` and `elastic` make
the problem that is simulated; `validity`, `wrong_units` and `doubts` check whether the theory
applies and whether the units are plausible, with what `limits` says of a drop.
"""
