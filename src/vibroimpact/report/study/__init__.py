"""The report of a study, and the study in its folder."""
