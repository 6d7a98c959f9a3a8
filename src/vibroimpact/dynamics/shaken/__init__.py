"""Plates whose supports move as is prescribed: vibrating tables, screens, decks of trucks."""
