"""Studies: many drops of one case, run so that none is lost, with dataset and report."""
