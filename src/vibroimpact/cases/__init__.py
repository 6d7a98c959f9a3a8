"""Cases: the file that a user writes, its reader, and the cases that ship with the package."""
