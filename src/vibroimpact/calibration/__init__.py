"""From what was measured, or wanted, to the parameters of a model."""
