"""Limits of the theory, one per module; `vibroimpact.cases.limit` defines what a limit is."""
