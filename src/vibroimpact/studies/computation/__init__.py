"""The computation of a study in chunks, and the dataset and ledger that it writes."""
