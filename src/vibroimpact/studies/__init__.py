"""Studies: many drops, which points they are at, and how they are run so that none is lost."""
