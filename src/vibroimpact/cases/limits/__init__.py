"""The limits of what a drop is computed with, one idea a file; `vibroimpact.cases.limit` says what one is."""
