"""`python -m vibroimpact`: the command line."""

from vibroimpact.cli import main

main()
