"""Charts: described once as data, drawn by plotly in pages and notebooks, and by
matplotlib as files.
"""
