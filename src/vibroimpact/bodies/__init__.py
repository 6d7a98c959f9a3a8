"""Bodies of an impact: rigid or elastic spheres and plates, from geometry and material."""
