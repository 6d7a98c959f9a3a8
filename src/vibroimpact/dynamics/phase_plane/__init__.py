"""Contacts of bodies that move rigidly, solved in the phase plane: the speed over the indentation."""
