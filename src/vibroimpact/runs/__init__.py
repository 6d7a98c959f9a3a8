"""One case run: its result folder, its report with figures and animation, and what the
terminal prints.
"""
