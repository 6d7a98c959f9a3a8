"""The contact laws shown: sheets, curves, and pages of the documentation."""
