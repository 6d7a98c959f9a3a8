"""The figures of the paper drawn anew, and the report that sets what it prints beside what is computed."""
