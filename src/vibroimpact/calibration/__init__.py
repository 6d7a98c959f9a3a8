"""From what was measured to the parameters of a model."""
