"""Contacts of bodies that move rigidly, integrated in time, and their histories."""
