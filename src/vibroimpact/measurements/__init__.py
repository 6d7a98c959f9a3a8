"""Files that measurements come in: tables in CSV, and universal files."""
