"""The common kit of all reports: figure style and layout, page templates, terminal tables
and progress bars.
"""
