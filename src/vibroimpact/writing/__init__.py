"""Writing whole or not at all: one file, one folder, or files into a folder that is there; and what dead processes have left."""
