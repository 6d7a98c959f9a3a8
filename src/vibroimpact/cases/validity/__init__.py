"""Limits of the theory, one per module; `vibroimpact.cases.limits.limit` says what a limit is."""
