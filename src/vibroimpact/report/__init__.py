"""What all reports are made with: the style of figures, pages, tables for the terminal, progress."""
