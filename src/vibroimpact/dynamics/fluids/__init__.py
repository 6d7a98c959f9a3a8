"""Air and liquids that spheres fly through: their values, and the drag on a sphere."""
