"""The report of a run: figures, and one page that shows them with the numbers and the case."""
