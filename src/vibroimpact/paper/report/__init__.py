"""The report of the reproduction: charts, Markdown and HTML pages, and the folder that
holds them.
"""
