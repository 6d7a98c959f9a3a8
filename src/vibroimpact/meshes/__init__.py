"""Reading and writing mesh files of other programs, and meshing geometry files."""
