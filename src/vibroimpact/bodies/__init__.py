"""Bodies: a mass or a fixity, made from geometry and material."""
