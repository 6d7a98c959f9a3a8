"""The report of the reproduction: figures, Markdown and HTML pages, and the folder that holds them."""
